// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/maps/parts.h"

namespace weft::bench {

/// Normals of a detail layer joined with those of a tilted base: mean degrees to the normals of summed
/// heights, and to the detail turned onto the base normal. A row each tilt, weave and blend.
Result<Rows> maps_detail(const MapsBenchOptions& options);

/// Facets of one alpha on facets of another: the single alpha that reflects most like it, and what each rule
/// of joining says, with its relative rms.
Result<Rows> maps_gloss(const MapsBenchOptions& options);

}  // namespace weft::bench
