// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/json_document.h"

// One quantity against another, for pages and for print: black and grey, series told apart by marks and
// dashes.

namespace weft::report {

/// One axis of a plot: values of a quantity to places of a drawing, linear or logarithmic.
struct PlotAxis {
  double low = 0, high = 1;  ///< the values at its ends; above 0 where it is logarithmic
  double from = 0, to = 1;   ///< where these ends are drawn
  bool log = false;

  /// An axis over all values that it can show, with a margin of 6 percent at both ends; without any from 0
  /// or, where it is logarithmic, from 1.
  static PlotAxis around(std::span<const double> values, bool log, double from, double to);

  /// Whether it can show the value: it is finite, and above 0 where the axis is logarithmic.
  bool takes(double value) const;
  double at(double value) const;

  /// The round numbers to write beside it, ascending. Linear, or logarithmic over less than a factor of
  /// three: steps of 1, 2 or 5 times a power of ten, three to nine numbers. Logarithmic over less than a
  /// factor of 20 nearly every digit, over less than 1000 the digits 1, 2 and 5, and beyond that powers of
  /// ten.
  std::vector<double> ticks() const;
};

/// A mark.
struct PlotPoint {
  double x = 0, y = 0;     ///< what an axis cannot show is left out (report/plot_svg.h)
  std::string label = {};  ///< written beside the mark; empty: none
};

/// Points that belong together and share a mark.
struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points = {};
  bool joined = false;  ///< by a line, in the order of the points
  bool marked = true;   ///< a mark at every point
};

/// Series on one pair of axes.
struct Plot {
  /// Empty: the plot is a figure of a page, which has a caption; it is drawn flatter then.
  std::string title = {};
  std::string x_label, y_label;
  std::vector<PlotSeries> series = {};
  /// Less is better on both axes: draws the staircase of the points that no other point beats.
  bool frontier = false;
  bool log_x = false, log_y = false;
  bool large = false;  ///< few marks and large letters, to be read from two metres
};

/// The drawing: 760 x 520 units, without a title 760 x 372, large 420 x 300 of the same letters. The same
/// plot gives the same bytes.
std::string plot_svg(const Plot& plot);

/// The points of all series that no other beats, by rising x.
std::vector<PlotPoint> frontier_of(const std::vector<PlotSeries>& series);

}  // namespace weft::report
