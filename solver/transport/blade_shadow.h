// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/cloth_spread.h"

namespace weft::solver {

/// One LED's light on a cloth without and with a straight opaque edge above it, by square cells of the
/// picture: sums of readings; NaN where either has none.
struct BladeCells {
  Image<float> plain, bladed;
  double cell_mm = 1;
  double away_x = 1, away_y = 0;  ///< from the LED, along the picture: where shadows fall; any length
};

/// How the light of a LED falls off across the edge of the blade's shadow. By a line's response of
/// exp(-|d| / l) / (2 l) of what spreads (ClothSpread), d from the edge of the shadow.
struct BladeShadow {
  ClothSpread spread;  ///< the share may come out below 0, by its sigma
  double share_sigma = 0, mean_sigma_mm = 0;
  double blur_mm = 0;    ///< standard deviation of the penumbra: LED, lens, and the relief of the yarns
  double floor = 0;      ///< light in the depth of the shadow over that beside it
  double length_mm = 0;  ///< of the edge that was read
  double residual = 0;   ///< rms, a share of the light

  /// Whether the share stands out of its sigma. Where it does not, nothing is known of the distance.
  bool tells() const { return spread.share >= 2 * share_sigma; }
};

/// Finds the edge of the shadow, which is lit on the side away from the LED, and fits line, blur, share and
/// distance to the ratio of both pictures. Sigma has what a jackknife over strips along the edge tells, as
/// residuals follow the yarns, what another law of spreading would make of the same light, and of the share
/// what light between yarns looks like. kBadData where no straight shadow crosses the cloth.
Result<BladeShadow> read_blade_shadow(const BladeCells& cells);

}  // namespace weft::solver
