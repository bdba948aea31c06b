// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/base/study.h"
#include "bench/cloths/block_errors.h"
#include "bench/cloths/error_network.h"
#include "core/base/result.h"

// Whether what blocks of simulated cloths show foretells errors better, once learned, than formulas do.

namespace weft::bench {

struct ForecastOptions {
  std::vector<std::filesystem::path> taught_on;  ///< lines of block_errors.h
  std::vector<std::filesystem::path> held;       ///< those of the table
};

/// Weights by which the logarithms of errors are told with the least squared misfit, cut at kMostMisfit, all
/// solves counting alike: the mean of several networks that begin differently, each by full batches of Adam
/// (Kingma and Ba, 2015). The same for the same blocks.
ErrorNetwork teach(const std::vector<BlockError>& blocks, std::uint64_t seed);

/// By level, the error of solves over what is foretold, by the formulas alone and by what was learned.
/// Columns: quality, solves, and formula_ or learned_ within_1.3, within_2, over_3 (shares) and worst.
Result<Rows> forecast_table(const ForecastOptions& asked, const StudyOptions& options);

}  // namespace weft::bench
