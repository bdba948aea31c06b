// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "core/base/vec.h"
#include "solver/reflectance/lobe_by_lights.h"
#include "solver/reflectance/pixel_fit.h"

namespace weft::solver {

/// Slopes of one reading of a pixel: by its b, by values that pixels share, and by the errors of its light in
/// the order of LobeByLights.
template <int kValues>
struct ReadingSlopes {
  double weight = 0;
  Vec3 by_b;
  Eigen::Matrix<double, kValues, 1> by_values = Eigen::Matrix<double, kValues, 1>::Zero();
  std::array<double, LobeByLights::kErrors> by_errors = {};
};

/// Leaves of the slopes by shared values what the pixel's own normal and albedo do not take up.
template <int kValues>
void take_out_pixel(std::span<ReadingSlopes<kValues>> readings) {
  PixelSystem system;
  std::array<Vec3, static_cast<std::size_t>(kValues)> by_both = {};
  for (const ReadingSlopes<kValues>& s : readings) {
    if (s.weight == 0) continue;
    system.add(s.by_b, s.weight, 0);
    for (int p = 0; p < kValues; ++p) {
      Vec3& mixed = by_both[static_cast<std::size_t>(p)];
      mixed = mixed + (s.weight * s.by_values[p]) * s.by_b;
    }
  }
  system.regularise();
  for (Vec3& each : by_both) each = system.solved(each);
  for (ReadingSlopes<kValues>& s : readings) {
    for (int p = 0; p < kValues; ++p) s.by_values[p] -= dot(by_both[static_cast<std::size_t>(p)], s.by_b);
  }
}

}  // namespace weft::solver
