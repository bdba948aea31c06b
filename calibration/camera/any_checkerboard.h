// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/camera/boards.h"
#include "core/image/image.h"

namespace weft::calibration {

/// Corners of a checkerboard, row by row.
struct CornerGrid {
  int columns = 0, rows = 0;
  std::vector<PixelPoint> corners;

  PixelPoint at(int i, int j) const { return corners[static_cast<std::size_t>(j * columns + i)]; }
};

/// The largest checkerboard of 3 x 3 corners or more, grown from corner to corner out of single squares,
/// whatever is about it. OpenCV's detector takes a rim of black or of cut squares for more of a board, and
/// finds other corners at each run. No corners: there is none.
CornerGrid any_checkerboard(View<const std::uint8_t> grey);

/// The board of so many columns and rows of corners within a rim of cut squares, as some are sold; none:
/// squares beyond it are whole, or it is not sure which are the rim.
std::optional<CornerGrid> within_rim(View<const std::uint8_t> grey, const CornerGrid& grid, int columns,
                                     int rows);

}  // namespace weft::calibration
