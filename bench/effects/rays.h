// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// Error and time of what is sampled, at 1, 4, 16 ... 4096 rays a pixel on the deep weave: the share of a LED
/// of 12 mm that each point sees, openness, and irradiance by one bounce at albedo 0.5 (1: that of a surface
/// that faces the LED). Errors are over one repeat of the weave against 64 times the most rays, of another
/// random stream; ns_per_pixel is of one thread, one frame for the LED, all frames for the others; `ratio` is
/// that over the default's. `threads` is for the reference.
Result<Rows> effects_rays(int threads);

}  // namespace weft::bench
