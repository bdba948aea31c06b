// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "core/image/image.h"
#include "solver/transport/relief.h"

namespace weft::solver {

/// As many pixels as a vector holds at most.
inline constexpr int kMostLanes = 16;

/// Heights of an area in pixels; where there is no picture, so deep that nothing is hidden by it.
Image<float> heights_around(const Relief& relief, Rect area);

/// A place relative to a pixel, as heights are read between the four pixels around it.
struct PointBetween {
  std::ptrdiff_t upper_left;  ///< from the pixel
  float right, down;          ///< shares of the way to the others
};

/// `right` columns to the right of a pixel and `down` rows below it.
inline PointBetween point_between(double right, double down, std::ptrdiff_t stride) {
  const double column = std::floor(right), row = std::floor(down);
  return {static_cast<std::ptrdiff_t>(row) * stride + static_cast<std::ptrdiff_t>(column),
          static_cast<float>(right - column), static_cast<float>(down - row)};
}

}  // namespace weft::solver
