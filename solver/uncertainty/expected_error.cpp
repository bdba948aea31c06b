// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/expected_error.h"

#include <algorithm>
#include <cmath>

namespace weft::solver {

double Forecast::log_factor(const BlockFacts& facts) const {
  std::array<double, kBlockFacts> scaled;
  for (std::size_t i = 0; i < scaled.size(); ++i) scaled[i] = (double{facts[i]} - mean[i]) / scatter[i];
  double total = sum[kHidden];
  for (std::size_t h = 0; h < kHidden; ++h) {
    double value = hidden[h][kBlockFacts];
    for (std::size_t i = 0; i < scaled.size(); ++i) value += hidden[h][i] * scaled[i];
    total += sum[h] * std::tanh(value);
  }
  return total;
}

const Forecast& forecast() {
  static const Forecast kTaught = {
#include "solver/uncertainty/forecast_weights.inc"
  };
  return kTaught;
}

float model_factor(const BlockFacts& facts) {
  const double factor = std::exp(forecast().log_factor(facts));
  return static_cast<float>(std::clamp(factor, kLeastFactor, kMostFactor));
}

}  // namespace weft::solver
