// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// Cloths through DNG files, with shadows, bounces, defocus and noise. In three families of matt weave at two
/// sizes of pixel one shot of ten has moved; in ten glossy cloths none has. How well the shift is measured,
/// and the mean error without movement, with registration off and with it on (pipeline/shifts.h).
/// `taken_back` is the share of the damage that registration undoes, `predicted_deg` cost_deg of the shot,
/// `real_deg` what the movement adds to the rms error.
Result<Rows> registration(int threads);

}  // namespace weft::bench
