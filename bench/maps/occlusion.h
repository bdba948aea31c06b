// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/maps/parts.h"

namespace weft::bench {

/// Line sweeps of 4, 8 and 16 directions, and horizon steps of solver/transport, on plain and deep weaves of
/// 10 and 20.75 pixels a yarn: openness against 1024 rays a pixel, bent normals against marching, and
/// processor time on a map of one megapixel by default.
Result<Rows> maps_occlusion(const MapsBenchOptions& options);

}  // namespace weft::bench
