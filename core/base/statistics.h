// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

// Order statistics. Each is one of the values: nothing is interpolated. None of the values is NaN.

namespace weft {

/// The value that stands at place `rank`, from 0, when the values rise. Reorders them.
template <typename T>
T value_of_rank(std::span<T> values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Those of the values that are finite.
template <typename T>
std::vector<T> finite(std::vector<T> values) {
  std::erase_if(values, [](T value) { return !std::isfinite(value); });
  return values;
}

/// The value of rank `share` * (n - 1), rounded, of n values; `share` is 0 to 1. NaN where there are none.
template <typename T>
T quantile(std::vector<T> values, double share) {
  if (values.empty()) return std::numeric_limits<T>::quiet_NaN();
  return value_of_rank<T>(values,
                          static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5));
}

/// The same with its rank rounded down.
template <typename T>
T lower_quantile(std::vector<T> values, double share) {
  if (values.empty()) return std::numeric_limits<T>::quiet_NaN();
  return value_of_rank<T>(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

/// The middle value, of an even number the upper one. NaN where there are none.
template <typename T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace weft
