// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace weft {

/// A FixedPoint is a picture of so many cells a side.
inline constexpr int kPointCells = 20;

/// Something that stays on the table or the frame of a rig and is known again by its picture: a mark, a
/// screw, a corner.
struct FixedPoint {
  std::string id;             ///< stays the same when the point is measured again
  double x_px = 0, y_px = 0;  ///< its middle, on the active area
  double sigma_px = 0;        ///< of either, a standard deviation
  int cell_px = 2;            ///< side of a cell; even
  std::string grey;  ///< the cells by rows, two hexadecimal digits each: 00 the darkest, ff the brightest

  friend bool operator==(const FixedPoint&, const FixedPoint&) = default;
};

}  // namespace weft
