// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "calibration/checks/rig_movement.h"
#include "calibration/run/calibrate_outcome.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

struct CalibrateUpdateOptions {
  /// Taken after the move: a session, or a folder of sessions of the sheet, as CheckRigOptions has it.
  std::filesystem::path session = {};
  std::filesystem::path from = {};    ///< the calibration to update; empty: the session's own
  std::filesystem::path sheet = {};   ///< sheet.toml where the session shows that sheet; empty: it does not
  std::filesystem::path output = {};  ///< the new calibration, which must not be there yet
  std::optional<double> paper_delta = {};  ///< of patches and sheet, as CalibrateCheckOptions has it
  MovementOptions movement = {};
};
void describe(Fields& fields, CalibrateUpdateOptions& options);

/// Fits again what has moved (calibration/checks/rig_movement.h), the rest held by what the calibration
/// knows of it, and writes a new calibration: camera.json where camera and table moved to each other,
/// lights.json where LEDs moved to the table or changed, every other part as it was, and report/update.html.
/// What was known of a LED goes with it where LEDs were exchanged; the new camera.json has no covariance. The
/// rig frame stays with the table. Sessions keep the calibration that they were taken with; `weft solve
/// --calibration` solves them again with this one.
///
/// Errors: as look_at_rig(); kBadData where nothing has moved, and so there is nothing to update, or where
/// what moved cannot be told from something else; then nothing is written.
Result<CalibrateOutcome> calibrate_update(const CalibrateUpdateOptions& options, const JobContext& context);

}  // namespace weft::calibration
