// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"

// Drawings over the frame as SVG, readable in print. The same input gives the same bytes.

namespace weft::report {

/// Values over the frame as coloured squares, row by row from the upper left, NaN white, with a scale from
/// `least` to `most`: without them from 0 to just over the 98th percentile.
struct FrameMap {
  int columns = 0, rows = 0;
  std::vector<double> values;  ///< columns x rows
  std::string unit;            ///< written after the upper end of the scale
  std::optional<double> least = {}, most = {};
};
std::string frame_map_svg(const FrameMap& map);

/// A shift in the frame.
struct Arrow {
  double x_px = 0, y_px = 0;    ///< where it begins
  double dx_px = 0, dy_px = 0;  ///< from there to its tip
};
/// Arrows in a frame, drawn `magnification` times as long as they are.
std::string arrows_svg(Size frame, std::span<const Arrow> arrows, double magnification);

}  // namespace weft::report
