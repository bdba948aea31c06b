// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/base/study.h"
#include "bench/cloths/block_errors.h"
#include "core/base/result.h"
#include "solver/uncertainty/expected_error.h"

// What blocks of simulated cloths tell of errors is learned, and held against what formulas say.

namespace weft::bench {

struct ForecastOptions {
  std::vector<std::filesystem::path> taught_on;  ///< lines of block_errors.h; empty: the weights in use
  std::vector<std::filesystem::path> held;       ///< those of the table
  std::filesystem::path weights;                 ///< where what was learned goes, as C++; empty: nowhere
};

/// Weights by which the logarithms of errors are told with the least squared misfit, cut at kMostMisfit, all
/// solves counting alike: the mean of several networks that begin differently, each by full batches of Adam
/// (Kingma and Ba, 2015). The same for the same blocks.
solver::Forecast teach(const std::vector<BlockError>& blocks, std::uint64_t seed);

/// Of each level: the error of solves over what is foretold, by the formulas alone and by what was learned.
/// Columns: quality, solves, and formula_ or learned_ within_1.3, within_2, over_3 (shares) and worst.
Result<Rows> forecast_table(const ForecastOptions& asked, const StudyOptions& options);

}  // namespace weft::bench
