// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

// Order statistics. Each is one of the values: nothing is interpolated.

namespace weft {

/// The value of rank `share` * (n - 1), rounded, of n values; `share` is 0 to 1. NaN where there are none.
/// The values are finite.
template <typename T>
T quantile(std::vector<T> values, double share) {
  if (values.empty()) return std::numeric_limits<T>::quiet_NaN();
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// The middle value, of an even number the upper one. NaN where there are none.
template <typename T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace weft
