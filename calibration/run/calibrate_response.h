// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "calibration/run/calibrate_outcome.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

struct CalibrateResponseOptions {
  std::filesystem::path input;   ///< dark/, ledNN/, ledNN+ledMM/, scale/ and trap/, any but one ledNN/ absent
  std::filesystem::path from;    ///< the calibration to change; empty: none
  std::filesystem::path output;  ///< the new one; must not be there
  std::string rig;               ///< its name where there is no `from`; empty: the input folder's
  std::filesystem::path trap = {};  ///< a set of part trap; empty: trap/ of `input`, if it is there
};
void describe(Fields& fields, CalibrateResponseOptions& options);

/// Measures gain, read noise, black level, linearity, bad photosites, exposure ratios and the white balance
/// of the LEDs from raw frames (calibration/response/response_measurement.h), checks the patches of a grey
/// scale (scale/scale.toml, scale_file.h) and the lens's veil in a black trap
/// (calibration/response/black_trap.h) where there are these, and writes a calibration with response.json,
/// hot.png (where there are dark frames) and report/response.html. Nothing is written unless all went well.
/// Errors as read_response_frames() and measure_response().
Result<CalibrateOutcome> calibrate_response(const CalibrateResponseOptions& options,
                                            const JobContext& context);

}  // namespace weft::calibration
