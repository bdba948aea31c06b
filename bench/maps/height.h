// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/maps/parts.h"

namespace weft::bench {

/// Heights of a draped plain weave with a quarter of a degree of noise (4 megapixels by default) as one solve
/// of the whole and in tiles, a row each. `to_whole_rms_px` and `to_whole_max_px` are against that whole
/// solve, `rms_error_px` is against the truth, each after the best plane; `us_per_pixel` is processor time.
Result<Rows> maps_height(const MapsBenchOptions& options);

}  // namespace weft::bench
