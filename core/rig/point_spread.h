// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace weft {

/// How wide lens and focus spread a point on the sensor: a round Gaussian. The photosite's own square is not
/// part of it.
struct PointSpread {
  std::array<double, 3> sigma_px = {};  ///< along x and along y, behind the red, green and blue filter

  friend bool operator==(const PointSpread&, const PointSpread&) = default;
};

}  // namespace weft
