// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/run/calibration_report.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// What a step of `weft calibrate` did.
struct CalibrateOutcome {
  std::filesystem::path folder;  ///< of the new calibration, or of the check's result; empty: nothing written
  Calibration calibration;       ///< as it is in `folder`
  CalibrationReport report;
  std::vector<std::string> warnings;  ///< a sentence each, beside the report's verdicts
};

}  // namespace weft::calibration
