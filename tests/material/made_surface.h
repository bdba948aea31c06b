// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "core/base/vec.h"
#include "material/surface.h"
#include "simulator/geometry/scene_surface.h"

namespace weft::material {

/// A grey surface whose pixels have the slopes of `slopes`(x, y).
inline Surface made_surface(Size size, const std::function<std::array<double, 2>(int, int)>& slopes,
                            double mm_per_pixel = 0.02) {
  Surface made = {mm_per_pixel,
                  false,
                  Image<float>(size, 2),
                  Image<float>(size, 3),
                  Image<float>(size),
                  Image<std::uint16_t>(size),
                  {},
                  {}};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto [p, q] = slopes(x, y);
      made.slope(x, y, 0) = static_cast<float>(p);
      made.slope(x, y, 1) = static_cast<float>(q);
      for (int c = 0; c < 3; ++c) made.albedo(x, y, c) = 0.4F;
      made.sigma_deg(x, y) = 0.2F;
    }
  }
  return made;
}

/// A cloth of the simulator, its middle in the picture's.
inline Surface woven_surface(Size size, const simulator::GeometrySettings& geometry,
                             double mm_per_pixel = 0.02) {
  const simulator::Surface cloth = simulator::surface_of(geometry);
  return made_surface(
      size,
      [&](int x, int y) {
        const Vec3 n = simulator::point_at(cloth, (x - size.width / 2.0) * mm_per_pixel,
                                           (size.height / 2.0 - y) * mm_per_pixel)
                           .normal;
        return std::array{-n.x / n.z, -n.y / n.z};
      },
      mm_per_pixel);
}

}  // namespace weft::material
