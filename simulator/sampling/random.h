// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

// Random numbers without state: the number of a pixel depends on seed, shot and place alone, so that neither
// threads nor tiles nor the order of work change a byte.

namespace weft::simulator {

/// Philox 4x32-10 (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// Two independent standard normals of a block of random bits (Box and Muller 1958); |value| < 8.6.
struct NormalPair {
  double first;
  double second;
};
NormalPair normal_pair(std::array<std::uint32_t, 4> bits);

/// Uniform in (0, 1) from 52 of 64 random bits.
double uniform(std::uint32_t high, std::uint32_t low);

/// From this mean on, poisson() uses an expansion instead of the exact inverse.
inline constexpr double kPoissonExpansionFrom = 64;

/// The Poisson variate with the given mean at the quantile of a standard normal. Below kPoissonExpansionFrom
/// by exact inversion of the distribution; above by the normal asymptotic expansion of that inverse (Giles,
/// "Algorithm 955", ACM TOMS 42, 2016, to order mean^-1/2), whose distribution differs from Poisson's by 3e-5
/// in total variation at mean 64 and less above, variance by 1.5e-6, mean not at all. A mean of 0 or less
/// gives 0.
double poisson(double mean, double normal);

}  // namespace weft::simulator
