// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/jobs/session_input.h"
#include "app/jobs/solve.h"
#include "core/calibration.h"
#include "core/result.h"

// What can be said of a solve before a frame is opened.

namespace weft::app {

/// plan_session() by a calibration that was read before, with no look at the frames: their names tell whether
/// they are raw, and the calibration's camera how large they are. Errors as of plan_session(), but for what
/// frames alone show.
Result<SessionPlan> plan_unopened(const SessionOptions& options, const Calibration& calibration);

/// The id that solve_session() gives the solve of this plan.
std::string id_of_solve(const SessionPlan& plan, const SolveOptions& options);

}  // namespace weft::app
