// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "app/cli/options.h"
#include "app/cli/verb.h"
#include "calibration/run/calibrate_outcome.h"
#include "core/base/job_context.h"

namespace weft::app {

/// The work of one step, by what its options have read.
using CalibrateWork = std::function<Result<calibration::CalibrateOutcome>(const JobContext&)>;

/// Does the work, and prints what came out of it: as JSON, or for people.
Result<calibration::CalibrateOutcome> run_and_print(const CalibrateWork& work, const CommonArguments& common);

/// Prints what a calibration makes different from the rig's own. `is_accepted` is said of it in JSON.
Result<void> print_change(const std::filesystem::path& rig_file, const std::filesystem::path& calibration,
                          bool is_accepted, const CommonArguments& common);
/// Has the rig file name it, and says so.
Result<void> accept_calibration(const std::filesystem::path& rig_file,
                                const std::filesystem::path& calibration);

/// Adds --strict. The step does its work, and prints what came out of it.
Run run_step(Options& options, CalibrateWork work);

/// The same of a step that asks whether a calibration holds: exit code 65 where it does not.
Run run_check(Options& options, CalibrateWork work);

// The verbs of `weft calibrate`: those that measure a part, and those that look at what was measured.
Verb calibrate_camera_verb();
Verb calibrate_response_verb();
Verb calibrate_color_verb();
Verb calibrate_lights_verb();
Verb calibrate_grey_verb();
Verb calibrate_check_verb();
Verb calibrate_accept_verb();
Verb calibrate_all_verb();
Verb calibrate_refresh_verb();
Verb calibrate_patches_verb();
Verb calibrate_update_verb();
Verb calibrate_history_verb();

}  // namespace weft::app
