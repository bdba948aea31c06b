// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/maps/parts.h"

namespace weft::bench {

/// Opacity of rendered mesh and lace over a light: rms and mean error of 1 - T, and of what is found. `way`
/// says whether it was found; where it was not, both are the same.
Result<Rows> maps_opacity(const MapsBenchOptions& options);

}  // namespace weft::bench
