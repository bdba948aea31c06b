// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solver/uncertainty/block_facts.h"

// What a small network makes of a block's facts. It was taught on simulated cloths, whose errors are known,
// by `weft bench forecast --teach`, which prints its weights (forecast_weights.inc).

namespace weft::solver {

/// A network of one hidden layer: tanh, then a sum. Inputs are the facts over their scatter.
struct Forecast {
  static constexpr std::size_t kHidden = 32;
  std::array<double, kBlockFacts> mean = {}, scatter = {};
  std::array<std::array<double, kBlockFacts + 1>, kHidden> hidden = {};  ///< the last weight is the bias
  std::array<double, kHidden + 1> sum = {};

  /// Natural logarithm of what the model's angle of the block is to be multiplied with.
  double log_factor(const BlockFacts& facts) const;
};

/// The one that solves use.
const Forecast& forecast();

/// What the model's angles in a block are multiplied with, kLeastFactor to kMostFactor: so the root mean
/// square of all parts of sigma comes to the error that such blocks have had.
float model_factor(const BlockFacts& facts);
inline constexpr double kLeastFactor = 0.2, kMostFactor = 12;

}  // namespace weft::solver
