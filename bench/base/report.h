// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <vector>

#include "core/json_document.h"

namespace weft::bench {

/// Rows of one benchmark: JSON objects with the same keys in the same order.
using Rows = std::vector<Json>;

/// {"machine": ..., "rows": ...}: what every `weft bench --json` prints.
Json document_of(const Rows& rows);

/// The rows as a table for people, a column a key.
std::string table_of(const Rows& rows);

/// The least wall time of `repeats` runs of body(), in seconds.
template <typename Body>
double least_seconds(int repeats, const Body& body) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    body();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return least;
}

}  // namespace weft::bench
