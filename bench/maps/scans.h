// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/maps/parts.h"

namespace weft::bench {

/// Heights of plain, twill and deep weave, an eighth of a megapixel each: from true normals against the true
/// heights, and from the normals that levels solve of rendered photographs (near light, shadows, bounces,
/// noise; cloths that no method is tuned on) against those of the true normals, both flattened. `rms_px` is
/// after the best plane, `share` is that of the relief, the 1st to 99th percentile; `mean_deg` is the angle
/// of the normals to the true ones.
Result<Rows> maps_scans(const MapsBenchOptions& options);

}  // namespace weft::bench
