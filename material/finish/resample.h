// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "material/finish/lookup.h"
#include "material/surface.h"

namespace weft::material {

/// A surface on the grid of a lookup, as straighten() says. `mm_per_column` and `mm_per_row` are the new
/// grid's, for the slopes.
Surface resampled(const Surface& surface, const Lookup& lookup, double mm_per_column, double mm_per_row,
                  int threads);

}  // namespace weft::material
