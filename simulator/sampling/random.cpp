// SPDX-License-Identifier: Apache-2.0
#include "simulator/sampling/random.h"

#include <cmath>

#include "core/base/vec.h"

namespace weft::simulator {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> x, std::array<std::uint32_t, 2> k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * x[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57} * x[2];
    x = {static_cast<std::uint32_t>(b >> 32) ^ x[1] ^ k[0], static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32) ^ x[3] ^ k[1], static_cast<std::uint32_t>(a)};
    k = {k[0] + 0x9E3779B9, k[1] + 0xBB67AE85};
  }
  return x;
}

double uniform(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 32 | low) >> 12;
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

NormalPair normal_pair(std::array<std::uint32_t, 4> bits) {
  const double radius = std::sqrt(-2 * std::log(uniform(bits[0], bits[1])));
  const double angle = 2 * kPi * uniform(bits[2], bits[3]);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

double poisson(double mean, double w) {
  if (!(mean > 0)) return 0;
  if (mean >= kPoissonExpansionFrom) {
    const double s = std::sqrt(mean);
    return std::floor(mean + s * w + (1 + w * w / 2) / 3 - w * (1 + w * w / 2) / (36 * s));
  }
  const double u = std::erfc(-w * std::sqrt(0.5)) / 2;
  double probability = std::exp(-mean), cumulative = probability, count = 0;
  while (cumulative < u && (count < mean || probability > 0x1p-60)) {
    probability *= mean / ++count;
    cumulative += probability;
  }
  return count;
}

}  // namespace weft::simulator
