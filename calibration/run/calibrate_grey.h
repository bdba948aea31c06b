// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "calibration/run/calibrate_outcome.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

struct CalibrateGreyOptions {
  std::filesystem::path session = {};  ///< of a grey scale that lies flat on the table
  std::filesystem::path scale = {};    ///< scale.toml (scale_file.h); empty: beside the session
  std::filesystem::path from = {};     ///< the calibration to change; empty: the session's own
  std::filesystem::path output = {};   ///< the new one; must not be there
};
void describe(Fields& fields, CalibrateGreyOptions& options);

/// Measures the flux of each LED by channel, and so its white balance, from a scan of a grey scale
/// (calibration/lights/grey_chart.h), and writes a calibration with them in its lights.json and
/// report/grey.html. LEDs stay where they are. Albedo is absolute from then on; what the chart does not know
/// of the fluxes is added to the covariance that the lights have. White patches are left out, for they were
/// measured by the light of before.
///
/// Verdicts: RESPONSE_BENT where the readings bend by over four standard deviations, GREY_MISFIT where
/// chi-square is over calibration::kMisfitFrom. Errors: as plan_session(), read_scale_file() and
/// fit_grey_chart(); kBadData for a scale without corners_px or outside the frame, for developed photographs
/// and for distant lights. Then nothing is written.
Result<CalibrateOutcome> calibrate_grey(const CalibrateGreyOptions& options, const JobContext& context);

}  // namespace weft::calibration
