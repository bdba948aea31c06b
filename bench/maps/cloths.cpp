// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/cloths.h"

#include "core/parallel.h"
#include "simulator/geometry/surface.h"

namespace weft::bench {

SampledCloth sampled(const simulator::GeometrySettings& geometry, Size size, double mm_per_pixel,
                     int threads) {
  SampledCloth cloth = {mm_per_pixel, Image<float>(size), Image<float>(size, 3)};
  const simulator::Surface surface = simulator::surface_of(geometry);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const auto at = simulator::point_at(surface, mm_per_pixel * x, -mm_per_pixel * y);
      cloth.height_mm(x, y) = static_cast<float>(at.height_mm);
      cloth.normal(x, y, 0) = static_cast<float>(at.normal.x);
      cloth.normal(x, y, 1) = static_cast<float>(at.normal.y);
      cloth.normal(x, y, 2) = static_cast<float>(at.normal.z);
    }
  });
  return cloth;
}

simulator::GeometrySettings cloth_of(simulator::Family family) {
  simulator::GeometrySettings geometry = simulator::family_settings(family);
  geometry.warp_pitch_mm = geometry.weft_pitch_mm = 10 * kClothPitch_mm;
  return geometry;
}

simulator::GeometrySettings draped_cloth(simulator::Family family) {
  simulator::GeometrySettings geometry = cloth_of(family);
  geometry.waves = {{.amplitude_mm = 0.6, .wavelength_mm = 40, .direction_deg = 20}};
  geometry.folds = {{.amplitude_mm = 1.5, .wavelength_mm = 30, .direction_deg = 70}};
  return geometry;
}

}  // namespace weft::bench
