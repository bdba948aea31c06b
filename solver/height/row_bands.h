// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/base/parallel.h"

namespace weft::solver {

/// Rows a task. Sums are added up by bands, so a change may change last digits.
inline constexpr int kBandRows = 32;

/// body(y0, y1, worker) for bands of rows, in parallel.
template <typename Body>
void for_each_band(int rows, int threads, const Body& body) {
  const int bands = (rows + kBandRows - 1) / kBandRows;
  parallel_for(static_cast<std::size_t>(bands), threads, [&](std::size_t band, int worker) {
    const int y0 = static_cast<int>(band) * kBandRows;
    body(y0, std::min(y0 + kBandRows, rows), worker);
  });
}

/// The sum of body(y0, y1) over bands of rows, added in their order: the same for any number of threads.
template <typename Body>
auto sum_over_bands(int rows, int threads, const Body& body) {
  using Sum = decltype(body(0, 0));
  std::vector<Sum> sums(static_cast<std::size_t>((rows + kBandRows - 1) / kBandRows));
  for_each_band(rows, threads,
                [&](int y0, int y1, int) { sums[static_cast<std::size_t>(y0 / kBandRows)] = body(y0, y1); });
  return std::accumulate(sums.begin(), sums.end(), Sum{});
}

}  // namespace weft::solver
