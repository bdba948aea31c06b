// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/oren_nayar.h"

#include <algorithm>

#include "simulator/reflectance/directions.h"
#include "simulator/reflectance/lambert.h"

namespace weft::simulator {

Rgb OrenNayar::evaluate(const Rgb& albedo, Vec3 l, Vec3 to_view) const {
  if (!(l.z > 0)) return {};
  constexpr double kSmallestCosine = 1e-4;
  const Vec3 v = above_horizon(to_view);
  const double variance = sigma * sigma;
  const double a = 1 - 0.5 * variance / (variance + 0.33);
  const double b = 0.45 * variance / (variance + 0.09);
  // cos(phi_l - phi_v) sin(alpha) tan(beta): alpha is the larger, beta the smaller of the two zenith angles.
  const double side_by_side = std::max(0.0, l.x * v.x + l.y * v.y) / std::max({l.z, v.z, kSmallestCosine});
  return times_lambert(a + b * side_by_side, albedo);
}

}  // namespace weft::simulator
