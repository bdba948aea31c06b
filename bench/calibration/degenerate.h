// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CalibrationDegenerateBenchOptions {
  int threads = 0;  ///< 0: all the machine has
  int seeds = 20;   ///< of noise, tape and poses; 1 to 1000
};

/// Captures that cannot say what is asked of them: all tilts under 2 degrees, a board or sheet seen edge-on,
/// a LED on the optical axis, one pose taken again and again, one sheet or board, the sum of 100 megapixels.
/// A row a case and kind ("lights": positions of LEDs, "camera": focal lengths and principal point, "sum":
/// the mean of white paper by channel), made by formulas of their own (bench/oracles/paper_oracle.h,
/// bench/oracles/board_views.h): in how many of `seeds` it is `refused` (by an error or as a misfit), and of
/// those accepted the predicted sigma (rms, in `unit`), the error over it (rms and worst) and the least and
/// most chi-square a degree of freedom, where the fit has one. The camera's is of the corners' noise that was
/// put in.
Result<Rows> calibration_degenerate_table(const CalibrationDegenerateBenchOptions& options);

}  // namespace weft::bench
