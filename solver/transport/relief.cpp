// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/relief.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/transport/planes.h"

namespace weft::solver {

Result<Relief> Relief::of(View<const float> height_mm, double mm_per_pixel) {
  const Size size = height_mm.size();
  if (size.width < 1 || size.height < 1 || size.width > kMostSide_px || size.height > kMostSide_px) {
    return bad_transport("height map", fmt::format("{} x {} pixels", size.width, size.height),
                         fmt::format("give from 1 to {} columns and rows", kMostSide_px));
  }
  if (!(mm_per_pixel > 0) || !std::isfinite(mm_per_pixel)) {
    return bad_transport("height map", fmt::format("{} mm a pixel", mm_per_pixel),
                         "give a finite pitch over 0");
  }
  Relief relief{height_mm, mm_per_pixel, height_mm(0, 0), height_mm(0, 0)};
  for (int y = 0; y < size.height; ++y) {
    const float* row = height_mm.row(y);
    for (int x = 0; x < size.width; ++x) {
      if (!std::isfinite(row[x])) {
        return bad_transport("height map", fmt::format("the height of pixel ({}, {}) is {} mm", x, y, row[x]),
                             "fill in heights that are missing");
      }
      relief.lowest_mm = std::min(relief.lowest_mm, row[x]);
      relief.highest_mm = std::max(relief.highest_mm, row[x]);
    }
  }
  const double range_px =
      (static_cast<double>(relief.highest_mm) - static_cast<double>(relief.lowest_mm)) / mm_per_pixel;
  if (range_px > kMostRange_px) {
    return bad_transport("height map", fmt::format("heights differ by {:.6g} pixels", range_px),
                         fmt::format("flatten the map to at most {} pixels", kMostRange_px));
  }
  return relief;
}

float Relief::top_px() const {
  return static_cast<float>((static_cast<double>(highest_mm) - static_cast<double>(lowest_mm)) /
                            mm_per_pixel);
}

}  // namespace weft::solver
