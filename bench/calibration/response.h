// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CalibrationResponseBenchOptions {
  int threads = 0;  ///< 0: all the machine has
  int seeds = 3;    ///< captures of each body, each with other noise and another fixed pattern; 1 to 100
};

/// `weft calibrate response` on simulated captures: a sheet of paper by LED 1, LED 2 and both at seven
/// exposures, two frames of each, and dark frames, as DNG files, by both bodies of the simulator. The sensor
/// is bent by half a percent, uneven, warm and noisy, its LEDs drift, its shutter is off by 0.4 percent. A
/// row a body and quantity: `truth`, `measured` (mean over seeds), `rms_error` and the `sigma` that the
/// calibration predicts for itself, `error_percent` (of the truth; of full scale for black level and
/// linearity) and the `bar_percent` asked for.
Result<Rows> calibration_response_table(const CalibrationResponseBenchOptions& options);

}  // namespace weft::bench
