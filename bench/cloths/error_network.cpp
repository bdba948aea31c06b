// SPDX-License-Identifier: Apache-2.0
#include "bench/cloths/error_network.h"

#include <cmath>

namespace weft::bench {

double ErrorNetwork::log_factor(const solver::BlockFacts& facts) const {
  std::array<double, solver::kBlockFacts> scaled;
  for (std::size_t i = 0; i < scaled.size(); ++i) scaled[i] = (double{facts[i]} - mean[i]) / scatter[i];
  double total = sum[kHidden];
  for (std::size_t h = 0; h < kHidden; ++h) {
    double value = hidden[h][scaled.size()];
    for (std::size_t i = 0; i < scaled.size(); ++i) value += hidden[h][i] * scaled[i];
    total += sum[h] * std::tanh(value);
  }
  return total;
}

}  // namespace weft::bench
