// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CalibrationColorBenchOptions {
  int threads = 0;                                     ///< 0: all the machine has
  std::filesystem::path spectra = "testdata/spectra";  ///< tables of LED, filters, chart and dyes
};

/// `weft calibrate color` on the simulated 24-patch chart through spectral filters and noise: as a session
/// that is solved, and as one photograph under one LED, by matrix and by the curve in xyY. `vora` is how much
/// of the observer's space the filters span, trace(P P') / 3 of the projections on both (Vora and Trussell
/// 1993); `vora_lit` the same with the LED behind the filters and daylight behind the observer. Then
/// CIEDE2000, mean over patches: of the camera's own colours, fitted, of held-out patches (each by the fit to
/// all others; `bar` is asked for), and of the cloth dyes of the folder, which no fit has seen.
Result<Rows> calibration_color_table(const CalibrationColorBenchOptions& options);

}  // namespace weft::bench
