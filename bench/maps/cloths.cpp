// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/cloths.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "simulator/geometry/scene_surface.h"

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

// The plane's two axes are uncorrelated on a whole frame.
HeightDifference height_difference(const Image<float>& a, const Image<float>& b, double mm_per_pixel) {
  const Size size = a.size();
  const double middle_x = (size.width - 1) / 2.0, middle_y = (size.height - 1) / 2.0;
  const auto error = [&](int x, int y) {
    return (static_cast<double>(a(x, y)) - static_cast<double>(b(x, y))) / mm_per_pixel;
  };
  double sum = 0, along_x = 0, along_y = 0, xx = 0, yy = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double u = x - middle_x, v = y - middle_y, e = error(x, y);
      sum += e;
      along_x += e * u;
      along_y += e * v;
      xx += u * u;
      yy += v * v;
    }
  }
  const double count = static_cast<double>(size.pixels());
  HeightDifference result;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double e =
          error(x, y) - sum / count - along_x / xx * (x - middle_x) - along_y / yy * (y - middle_y);
      result.rms += e * e / count;
      result.largest = std::max(result.largest, std::abs(e));
    }
  }
  result.rms = std::sqrt(result.rms);
  return result;
}

double relief(const Image<float>& height_mm, double mm_per_pixel) {
  std::vector<float> sorted;
  for (int y = 0; y < height_mm.height(); ++y) {
    const float* row = height_mm.plane().row(y);
    sorted.insert(sorted.end(), row, row + height_mm.width());
  }
  std::ranges::sort(sorted);
  const std::size_t tail = sorted.size() / 100;
  return static_cast<double>(sorted[sorted.size() - 1 - tail] - sorted[tail]) / mm_per_pixel;
}

}  // namespace weft::bench
