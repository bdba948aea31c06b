// SPDX-License-Identifier: Apache-2.0
#include "material/maps/cavity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/parallel.h"
#include "material/maps/gaussian_grid.h"

namespace weft::material {
namespace {

constexpr double kRmsOfRange = 3;

Error unusable_cavity(const char* why, const char* remedy) {
  return {ErrorKind::kUsage, "no cavity map of this height map", "", why, remedy};
}

// Writes height less its surroundings; gives the sum of squares and the count of a row.
struct RowSquares {
  double sum = 0, count = 0;
};
RowSquares stand_out(const GaussianGrid& around, View<const float> height, int y, float* out) {
  RowSquares squares;
  around.read(y, out);
  for (int x = 0; x < height.width(); ++x) {
    const bool is_there = std::isfinite(height(x, y));
    out[x] = is_there ? height(x, y) - out[x] : 0.0f;
    if (!is_there) continue;
    squares.sum += static_cast<double>(out[x]) * static_cast<double>(out[x]);
    squares.count += 1;
  }
  return squares;
}

}  // namespace

Result<Cavity> cavity(View<const float> height_mm, const CavityOptions& options) {
  const Size size = height_mm.size();
  if (size.width <= 0 || size.height <= 0) return unusable_cavity("it is empty", "give a height map");
  if (!(options.mm_per_pixel > 0) || !(options.radius_mm >= options.mm_per_pixel) ||
      !(options.range_mm >= 0)) {
    return unusable_cavity("the radius is under a pixel, or a length is out of range",
                           "give millimetres a pixel, and a radius of a pixel or more");
  }
  const GaussianGrid around(height_mm, {},
                            {options.radius_mm / options.mm_per_pixel / 2, options.is_tile, options.threads});
  Cavity result = {Image<float>(size), options.range_mm};
  std::vector<RowSquares> rows(static_cast<std::size_t>(size.height));
  parallel_for(rows.size(), options.threads, [&](std::size_t y, int) {
    rows[y] =
        stand_out(around, height_mm, static_cast<int>(y), result.cavity.plane().row(static_cast<int>(y)));
  });
  RowSquares all;
  for (const RowSquares& row : rows) {
    all.sum += row.sum;
    all.count += row.count;
  }
  if (result.range_mm == 0 && all.count > 0) result.range_mm = kRmsOfRange * std::sqrt(all.sum / all.count);
  const double scale = result.range_mm > 0 ? 0.5 / result.range_mm : 0;
  parallel_for(rows.size(), options.threads, [&](std::size_t y, int) {
    float* row = result.cavity.plane().row(static_cast<int>(y));
    for (int x = 0; x < size.width; ++x) {
      row[x] = static_cast<float>(std::clamp(0.5 + scale * static_cast<double>(row[x]), 0.0, 1.0));
    }
  });
  return result;
}

}  // namespace weft::material
