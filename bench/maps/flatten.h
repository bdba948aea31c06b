// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/maps/parts.h"

namespace weft::bench {

/// What each way of flattening leaves of a slow error of 1.5 degrees, a cubic one and one of seventh degree
/// in the corners, and what it takes from the same cloth without one, on a plain weave of 10 pixels a yarn,
/// turned by 1.3 degrees, whose yarns stand off their places by 4 percent of their pitch (rms). Frames of 512
/// x 512 and 1536 x 1024 pixels, rms in degrees.
Result<Rows> maps_flatten(const MapsBenchOptions& options);

}  // namespace weft::bench
