// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "calibration/checks/flatness.h"
#include "calibration/checks/rig_movement.h"
#include "calibration/run/calibrate_outcome.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

// Whether a calibration holds. A result is a folder with result.json (weft.calibration-check/1: date, what
// was checked, calibration, passed, numbers) and the report check.html and check.json; `weft calibrate
// history` reads it.

namespace weft::calibration {

/// On evidence that the calibration was not fitted to: sheets of white paper with tags that lie flat (another
/// one, or the same one turned) and tilted.
struct CalibrateCheckOptions {
  std::filesystem::path input = {};    ///< a session, or a folder of sessions (*.weft)
  std::filesystem::path session = {};  ///< in its place, what calibrate_check_rig() looks at
  std::filesystem::path from = {};     ///< the calibration to check; empty: each session's own
  std::filesystem::path sheet = {};    ///< sheet.toml; empty: in the folder `input`, or beside the session
  std::filesystem::path output =
      {};              ///< folder for the result, which must not be there; empty: nothing is written
  int square_px = 32;  ///< side of the squares that are compared; even, 8 to 512
  /// The paper's departure from Lambert's law, as `calibrate lights` reports it (-0.5 to 1); absent: of
  /// sheet.toml, else of the calibration's report, else 0.
  std::optional<double> paper_delta = {};
  CheckLimits limits = {};
};
void describe(Fields& fields, CalibrateCheckOptions& options);

/// The report's verdicts are empty where the calibration is accepted. In the folder of the sessions
/// there may be check.toml with the angle of a wedge, [[plane]] session, tilt_deg, azimuth_deg; else a
/// sheet's angle is what its tags say. Errors: as plan_session() and sheet_evidence(); kNoInput where there
/// is no session.
Result<CalibrateOutcome> calibrate_check(const CalibrateCheckOptions& options, const JobContext& context);

/// On what a scan shows beside its cloth: did the rig move since it was calibrated?
struct CheckRigOptions {
  /// Any session that shows tags, white patches or the sheet; or a folder of sessions (*.weft) of the sheet
  /// in several poses, the first of which shows the table's tags, too.
  std::filesystem::path session = {};
  std::filesystem::path from = {};  ///< the calibration; empty: the session's own
  /// sheet.toml where the session shows that sheet; empty: that in a folder of sessions, else it does not.
  std::filesystem::path sheet = {};
  std::filesystem::path output = {};       ///< as above
  std::optional<double> paper_delta = {};  ///< of patches and sheet, as above
  MovementOptions movement = {};
};

/// What happened to the rig, and what it costs.
struct RigCheck {
  Movement movement;
  MovementCost cost;
  Calibration calibration;     ///< that was checked
  std::filesystem::path from;  ///< its folder
  std::vector<Pose> sheets;    ///< rig_from_sheet of each that was seen
};
Result<RigCheck> look_at_rig(const CheckRigOptions& options, const JobContext& context);

/// The same with report and result. The verdicts name what happened, each with a remedy, where its cost
/// matters() (calibration/checks/rig_movement.h).
Result<CalibrateOutcome> calibrate_check_rig(const CheckRigOptions& options, const JobContext& context);

}  // namespace weft::calibration
