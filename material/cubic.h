// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace weft::material {

/// Weight of a sample `t` pixels away: cubic convolution with a = -1/2 (Keys 1981, eq. 15), 0 from 2 pixels.
inline double cubic_weight(double t) {
  t = std::abs(t);
  if (t < 1) return (1.5 * t - 2.5) * t * t + 1;
  return t < 2 ? ((-0.5 * t + 2.5) * t - 4) * t + 2 : 0;
}

}  // namespace weft::material
