// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace weft::report {

/// One axis of a plot: values of a quantity to places of a drawing, linear or logarithmic.
struct Axis {
  double low = 0, high = 1;  ///< the values at its ends; above 0 where it is logarithmic
  double from = 0, to = 1;   ///< where these ends are drawn
  bool log = false;

  /// An axis over all values that it can show, with a margin of 6 percent at both ends; without any from 0
  /// or, where it is logarithmic, from 1.
  static Axis around(std::span<const double> values, bool log, double from, double to);

  /// Whether it can show the value: it is finite, and above 0 where the axis is logarithmic.
  bool takes(double value) const;
  double at(double value) const;

  /// The round numbers to write beside it, ascending. Linear, or logarithmic over less than a factor of
  /// three: steps of 1, 2 or 5 times a power of ten, three to nine numbers. Logarithmic over less than a
  /// factor of 20 nearly every digit, over less than 1000 the digits 1, 2 and 5, and beyond that powers of
  /// ten.
  std::vector<double> ticks() const;
};

}  // namespace weft::report
