// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/fibres.h"

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {

Fibres::Fibres(double amplitude_mm, double spacing_mm, double angle, double length_mm, int yarns,
               std::int64_t seed, std::uint32_t stream)
    : amplitude_mm_(amplitude_mm), yarns_(yarns), waves_{} {
  const auto bits = static_cast<std::uint64_t>(seed);
  const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(bits),
                                            static_cast<std::uint32_t>(bits >> 32)};
  constexpr std::uint32_t kFrequencies = 0xFFFFFFFF;  // a yarn that no cloth has
  constexpr double kStraightness = 0.1;               // how far fibres stray from their angle, radians
  for (std::uint32_t w = 0; w < kWaves; ++w) {
    const auto r = philox({kFrequencies, w, stream, 0}, key);
    const double octaves = (w + uniform(r[0], r[1])) / kWaves - 0.5;  // stratified: the band is filled
    const double across = 2 * kPi / spacing_mm * std::exp2(octaves);
    const double lean = angle + kStraightness * (2 * uniform(r[2], r[3]) - 1);
    const double whole_turns = std::round(-across * std::tan(lean) * length_mm / (2 * kPi));
    waves_[w] = {across, whole_turns * 2 * kPi / length_mm};
  }
  for (std::uint32_t yarn = 0; yarn < static_cast<std::uint32_t>(yarns); ++yarn) {
    for (std::uint32_t w = 0; w < kWaves; ++w) {
      const auto r = philox({yarn, w, stream, 0}, key);
      phases_.push_back(2 * kPi * uniform(r[0], r[1]));
    }
  }
}

Fibres::Relief Fibres::at(std::int64_t yarn, double across_mm, double along_mm) const {
  const auto own = static_cast<std::size_t>((yarn % yarns_ + yarns_) % yarns_) * kWaves;
  Relief sum = {0, 0, 0};
  for (std::size_t w = 0; w < kWaves; ++w) {
    const auto& k = waves_[w];
    const double phase = k.across * across_mm + k.along * along_mm + phases_[own + w];
    const double cosine = std::cos(phase);
    sum.height_mm += std::sin(phase);
    sum.across += k.across * cosine;
    sum.along += k.along * cosine;
  }
  const double each_mm = amplitude_mm_ / kWaves;
  return {each_mm * sum.height_mm, each_mm * sum.across, each_mm * sum.along};
}

double Fibres::steepest_slope() const {
  double sum = 0;
  for (const Frequency& k : waves_) sum += std::hypot(k.across, k.along);
  return amplitude_mm_ / kWaves * sum;
}

}  // namespace weft::simulator
