// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/maps/parts.h"

namespace weft::bench {

/// Rules of mips against the mean of the shaded pixels beneath a texel, GGX of F0 0.04: relative rms of
/// f (n . l) over base alphas 0.1, 0.3 and 0.5, hundred footprints a side and 128 lights. A row each rule and
/// set of cloths: `page` has the slopes of docs/filtering.md, `other` other kinds. Columns are view and
/// pixels a side of the footprint; then all of them, by base alpha, the satin alone, and processor time.
Result<Rows> maps_mips(const MapsBenchOptions& options);

/// Figures 17 to 20 of seed 000 as numbers: the same error by rule, of a rougher normal map under a lobe of
/// 0.05 (17), of Beckmann's lobe under grazing light (18), and seen at 75 degrees through the footprint that
/// is seen and through the square of it that trilinear filtering takes (20). Of figure 19 the angle from
/// mirrored direction to the lobe's peak.
Result<Rows> maps_figures(const MapsBenchOptions& options);

}  // namespace weft::bench
