// SPDX-License-Identifier: Apache-2.0
#include "report/axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::report {
namespace {

constexpr double kMargin = 0.06;          // of the axis, between its ends and the outermost values
constexpr double kLeastDecades = 0.3;     // that the margin of a logarithmic axis is reckoned from
constexpr double kFewestDigits = 3;       // high over low from which the digits of decades serve as ticks
constexpr double kMostSteps = 8;          // of a linear axis
constexpr double kLeastMagnitude = 1e-3;  // that the margin of a single value is reckoned from

std::vector<double> linear_ticks(double low, double high) {
  double step = std::pow(10, std::floor(std::log10((high - low) / 3)));
  for (const double factor : {2.0, 2.5}) {
    if ((high - low) / step > kMostSteps) step *= factor;
  }
  const double first = std::ceil(low / step);
  std::vector<double> values;
  for (int i = 0; (first + i) * step <= high; ++i) values.push_back((first + i) * step);
  return values;
}

std::vector<double> logarithmic_ticks(double low, double high) {
  static const std::vector<double> kAll = {1, 1.5, 2, 3, 4, 5, 6, 8}, kSome = {1, 2, 5}, kOne = {1};
  const std::vector<double>& digits = high / low < 20 ? kAll : high / low < 1e3 ? kSome : kOne;
  std::vector<double> values;
  for (int decade = static_cast<int>(std::floor(std::log10(low))); std::pow(10, decade) <= high; ++decade) {
    for (const double digit : digits) {
      const double value = digit * std::pow(10, decade);
      if (value >= low && value <= high) values.push_back(value);
    }
  }
  return values;
}

}  // namespace

Axis Axis::around(std::span<const double> values, bool log, double from, double to) {
  Axis axis = {log ? 1.0 : 0.0, log ? 10.0 : 1.0, from, to, log};
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : values) {
    if (!axis.takes(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  if (least > most) return axis;
  if (log) {
    const double pad = std::pow(10, kMargin * std::max(std::log10(most / least), kLeastDecades));
    axis.low = least / pad;
    axis.high = most * pad;
  } else {
    const double pad =
        most > least ? kMargin * (most - least) : std::max(std::abs(most), kLeastMagnitude) / 2;
    axis.low = least - pad;
    axis.high = most + pad;
  }
  return axis;
}

bool Axis::takes(double value) const {
  return std::isfinite(value) && (!log || value > 0);
}

double Axis::at(double value) const {
  const double share = log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return from + (to - from) * share;
}

std::vector<double> Axis::ticks() const {
  return log && high / low >= kFewestDigits ? logarithmic_ticks(low, high) : linear_ticks(low, high);
}

}  // namespace weft::report
