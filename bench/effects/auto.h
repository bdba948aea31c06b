// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// `effects = "auto"` at 0.25 sigma against every effect there is, on a gallery of small scenes: how far the
/// frames of all LEDs and the dark one differ before the converter, noise off on both sides, in sigma of the
/// noise of each photosite, and what share of the time auto takes. `left_out` names what it does without;
/// `ns_per_pixel` is auto's, `ratio` over that of all effects.
Result<Rows> effects_auto(int threads);

}  // namespace weft::bench
