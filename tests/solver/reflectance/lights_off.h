// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "solver/reflectance/lobe_by_lights.h"
#include "tests/solver/reflectance/pixels.h"

// Pixels in closed form under a rig that is not quite what its calibration says.

namespace weft::solver {

/// What is wrong with one light: the logarithm of its strength, and its direction.
struct LightError {
  double log_strength = 0;
  Vec3 turn;
};

/// The same pixels for a seed, whatever the errors. The solver is told of none of them.
inline PixelTruth pixels_off(const Lobe& lobe, std::size_t count, const ClothOfPixels& cloth,
                             const std::vector<LightError>& errors, std::uint64_t seed) {
  const std::vector<Vec3> told = ten_directions();
  return pixels_by(
      [&](Vec3 n, double albedo, double yarn, Random& random) {
        std::vector<LobeReading> readings;
        for (std::size_t k = 0; k < told.size(); ++k) {
          const LitFrom from(normalized(told[k] + errors[k].turn), {0, 0, 1});
          const double bare = modelled(lobe, albedo * n, from, yarn) * std::exp(errors[k].log_strength);
          readings.push_back(reading_of(bare, LitFrom(told[k], {0, 0, 1}), cloth.noise, random));
        }
        return readings;
      },
      count, cloth, seed);
}

/// Covariance of independent errors, in the order of LobeByLights.
inline std::vector<double> covariance_of_lights(double log_strength, double turn) {
  constexpr std::size_t kAll = 10 * LobeByLights::kErrors;
  std::vector<double> covariance(kAll * kAll, 0.0);
  for (std::size_t i = 0; i < kAll; ++i) {
    const double sigma = i % LobeByLights::kErrors == 0 ? log_strength : turn;
    covariance[i * kAll + i] = sigma * sigma;
  }
  return covariance;
}

}  // namespace weft::solver
