// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct PriceTableOptions {
  std::filesystem::path scenes = "testdata/scenes";  ///< from where the program runs
  std::vector<double> megapixels = {1, 8};
  int threads = 0;
};

/// What `weft solve --explain` foretells of whole sessions, the demo and shot silk and two cloths of the set
/// held out, against what the solves then give and take: a row for each scene, size and level, with degrees,
/// the share of the cloth that they hold for, and seconds, each foretold and true, and their ratios.
Result<Rows> price_table(const PriceTableOptions& options);

}  // namespace weft::bench
