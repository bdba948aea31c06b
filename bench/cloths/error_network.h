// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "solver/uncertainty/block_facts.h"

namespace weft::bench {

/// A network of one hidden layer, tanh and then a sum, that tells from a block's facts what the model's part
/// of its sigma is to be multiplied with.
struct ErrorNetwork {
  static constexpr std::size_t kHidden = 32;
  std::array<double, solver::kBlockFacts> mean = {}, scatter = {};  ///< of the facts
  std::array<std::array<double, solver::kBlockFacts + 1>, kHidden> hidden =
      {};  ///< the last weight is the bias
  std::array<double, kHidden + 1> sum = {};

  /// Natural logarithm of the factor.
  double log_factor(const solver::BlockFacts& facts) const;
};

}  // namespace weft::bench
