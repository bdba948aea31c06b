// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// One shot of ten in which the cloth has moved, on three families of weave at two sizes of pixel, with
/// shadows, bounces, defocus and noise, through DNG files: how well the shift is measured, and the mean error
/// of `fast` without movement, with it, and after registration (pipeline/shifts.h). `predicted_deg` is
/// cost_deg of the moved shot, `real_deg` what the movement adds to the rms error.
Result<Rows> registration(int threads);

}  // namespace weft::bench
