// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/rig/session.h"
#include "solve/input/session_input.h"
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

/// Where a session has photographs that no rig took, with `lights.lp` and perhaps a mask beside them.
inline constexpr const char* kPhotographsFolder = "photographs";
inline constexpr const char* kLightsFile = "lights.lp";

/// How such photographs are read: as the options say, and where they do not as the session says.
PhotoReading reading_of(const SessionOptions& options, const Session& session);

/// The plan of a session of such photographs: `begun` has the session, `lit` the shots to solve from. kUsage
/// for a calibration that is named; kBadData for bytes that are not those that were imported; errors of
/// plan_photos().
Result<SolvePlan> plan_photographs(const SessionOptions& options, const std::vector<Shot>& lit,
                                   SolvePlan begun);

}  // namespace weft::solve
