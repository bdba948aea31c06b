// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"

// Drawings of reports as SVG, readable in print. The same input gives the same bytes.

namespace weft::app {

/// Values over the frame as coloured squares, row by row from the upper left, NaN white, with a scale from
/// `least` to `most`: without them from 0 to just over the 98th percentile.
struct FrameMap {
  int columns = 0, rows = 0;
  std::vector<double> values;
  std::string unit;
  std::optional<double> least = {}, most = {};
};
std::string frame_map_svg(const FrameMap& map);

/// Arrows at places of the frame, `magnification` times as long as they are.
struct Arrow {
  double x_px = 0, y_px = 0, dx_px = 0, dy_px = 0;
};
std::string arrows_svg(Size frame, std::span<const Arrow> arrows, double magnification);

/// Curves over one axis, told apart by their dashes, marks at every point.
struct Curve {
  std::string name;
  std::vector<double> x, y;
  bool joined = true;  ///< else marks alone
};
struct LinePlot {
  std::string x_label, y_label;
  std::vector<Curve> curves;
  bool log_x = false, log_y = false;  ///< points that are not above 0 are left out
};
std::string lines_svg(const LinePlot& plot);

}  // namespace weft::app
