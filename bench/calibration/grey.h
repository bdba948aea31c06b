// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CalibrationGreyBenchOptions {
  int threads = 0;  ///< 0: all the machine has
  int seeds = 200;  ///< charts a row, each with other errors; 1 to 10000
};

/// Fluxes and white balances of ten LEDs from a chart of the nine greys of the Munsell scale, made by
/// formulas of their own (bench/oracles/grey_oracle.h). A row a case and quantity: "flux" and "balance"
/// (percent), with LEDs at their true places against the truth, and with LEDs as five poses of white paper
/// found them against what the paper found; then "bend" (percent of the light at full scale) of a response
/// bent by 0 to 100 percent. `rms_error` (of a bend: its mean), the `sigma` that the fit predicts, the
/// Cramer-Rao bound, `error_over_sigma`, the `bar` asked for; for bends `free_parabola`: what
/// calibration::check_scale leaves of it, percent rms.
Result<Rows> calibration_grey_table(const CalibrationGreyBenchOptions& options);

}  // namespace weft::bench
