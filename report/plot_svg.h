// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/json_document.h"

// A scatter of one quantity against another, both on logarithmic axes, for pages and for print: black and
// grey, series told apart by their marks, every mark labelled.

namespace weft::bench {

struct PlotPoint {
  double x = 0, y = 0;  ///< over 0; others are left out
  std::string label;    ///< empty: none
};

struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;
  bool joined = false;  ///< by a line, in their order
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotSeries> series;
  /// Less is better on both axes: draws the staircase of the points that no other point beats.
  bool frontier = false;
};

/// The drawing, 760 x 520 units. The same plot gives the same bytes.
std::string plot_svg(const Plot& plot);

/// The same numbers for programs: schema weft.plot/1.
Json plot_json(const Plot& plot);

/// The points of all series that no other beats, by rising x.
std::vector<PlotPoint> frontier_of(const std::vector<PlotSeries>& series);

}  // namespace weft::bench
