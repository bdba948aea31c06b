// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/run/calibration_report.h"
#include "calibration/run/last_check.h"
#include "calibration/run/rig_look.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

struct CalibrateHistoryOptions {
  std::filesystem::path rig;       ///< folder that holds calibrations and results of checks, at any depth
  std::filesystem::path sessions;  ///< folder of sessions to look for affected ones in; empty: none
  std::filesystem::path output;    ///< folder to make for history.html and history.json; empty: none
  /// The rig's calibration of now, which affected sessions would be solved again by; empty: the newest.
  std::filesystem::path calibration = {};
};

/// A calibration beside a rig file, and what is known of it.
struct ListedCalibration {
  std::filesystem::path folder;
  std::string id, measured;  ///< when; ISO 8601, empty: nobody said
  std::vector<std::string> parts;
  std::optional<LastCheck> check;
};
/// Every calibration below a folder, the newest first; what cannot be read is left out. Those in sessions are
/// copies and none of these. kNoInput where the folder cannot be read.
Result<std::vector<ListedCalibration>> list_calibrations(const std::filesystem::path& rig);

/// A session that was taken with a calibration that did not hold any more, or may not have.
struct AffectedSession {
  std::filesystem::path folder;
  std::string time;  ///< of its first shot
  /// Error of its normals, as its own look or the check that found the move predicts it; a check on sheets
  /// predicts none.
  std::optional<double> predicted_mean_deg = {}, predicted_worst_deg = {};
  bool after_move = false;  ///< by its own look, else by the date of that check; else the move may have come
                            ///< after it
  std::string says = {};    ///< its own look; empty: nobody looked
  /// After the move, and the calibration of now explains its look better than its own: to be solved again.
  bool is_concerned = false;
};

/// What a scan showed of its rig.
struct DatedLook {
  std::filesystem::path folder;
  RigLook look;
};

/// What became of a rig from its first calibration on.
struct CalibrationHistory {
  CalibrationReport report;  ///< table and plots of what was measured, and what checks said
  std::vector<AffectedSession> affected;
  std::vector<DatedLook> looks;  ///< of sessions that have one, the oldest first
  int sessions = 0;              ///< sessions that were looked at
  int without_time = 0;          ///< sessions without a time: nobody can tell whether a move affects them
  std::vector<std::string> warnings;  ///< folders that could not be read, and sessions without a time
};

/// Everything that is known of a rig over time: positions and flux of its LEDs and pose of its camera, from
/// the calibrations in their order of `measured`, and the results of checks.
///
/// A check that fails says that the rig moved at some time since its calibration was measured, or since the
/// last check of that calibration that passed; where LEDs have changed, since the last one that passed and
/// saw LEDs. Affected are the sessions taken with the calibration from that time on, until a check passes
/// again. A session that was looked at (calibration/run/rig_look.h) tells itself whether it is, but of LEDs
/// only where it shows white patches. One whose current solve is by the calibration of now is none of them.
///
/// Errors: kNoInput where a folder cannot be read or there is no calibration in `rig`.
Result<CalibrationHistory> calibrate_history(const CalibrateHistoryOptions& options,
                                             const JobContext& context);

}  // namespace weft::calibration
