// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/rig/gloss_scale.h"

// What two lobes make together, on the scales of core/rig/gloss_scale.h.

namespace weft::material {

using weft::alpha_of;
using weft::alpha_of_power;
using weft::alpha_range;
using weft::AlphaRange;
using weft::blinn_phong_power;
using weft::gloss_scale_named;
using weft::GlossScale;
using weft::name_of;
using weft::on_scale;

/// How the lobe of a base and that of a detail layer on it become one.
enum class GlossJoin {
  kMeasured,       ///< (a^p + b^p)^(1/p), p = 9/7 + 4/3 (a^2 + b^2): fitted to `weft bench maps --part gloss`
  kLengths,        ///< normal_length() multiplies (seed 001 eq. 34)
  kVariances,      ///< root of the sum of squares
  kPrintedGlosses  ///< fit of kLengths to the glosses of eq. 2, up to 0.017 off (seed 001 eq. 35-37, listing
                   ///< 2)
};

/// The alpha of a surface of `base` whose facets carry `detail`; never below either, never above 1, and the
/// other where one is 0. (The printed fit is as printed: clamped to 1, and nothing more.)
double joined_alpha(double base, double detail, GlossJoin join = GlossJoin::kMeasured);

}  // namespace weft::material
