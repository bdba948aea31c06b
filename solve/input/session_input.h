// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/image_io/linear_image.h"
#include "core/rig/calibration.h"
#include "core/rig/photo_reading.h"
#include "solve/photographs/solve_plan.h"
#include "solver/method.h"

namespace weft::solve {

/// Which session is solved, and by which of its LEDs.
struct SessionOptions {
  std::filesystem::path folder;
  std::filesystem::path calibration;  ///< empty: the session's own
  std::vector<int> leds;              ///< empty: all that were lit
  Json accepted_moved = {};           ///< beside the session's own word (docs/formats.md)
  PhotoReading reading = {};          ///< of photographs that no rig took, over what the session says
  bool forgets_reading = false;       ///< what the session says of them counts no more
  Clipped clipped = Clipped::kMark;   ///< what becomes of their full scale, as the method has it
};

/// Everything that can be checked before an hour of work is checked here.
Result<SolvePlan> plan_session(const SessionOptions& options);

/// plan_session() by a calibration that was read before, with no look at the frames: their names tell whether
/// they are raw, and the calibration's camera how large they are. Errors as of plan_session(), but for what
/// frames alone show.
Result<SolvePlan> plan_unopened(const SessionOptions& options, const Calibration& calibration);

/// Adds a session of the same cloth as it lay otherwise to the plan that `first` made: scanned with the same
/// calibration, and films if there were any. kUsage where the method seeks no lobe or both are one session;
/// kBadData where they were not scanned alike; errors as of plan_session().
Result<void> plan_second_pose(const std::filesystem::path& folder, const solver::MethodName& method,
                              const SessionOptions& first, SolvePlan& plan);

}  // namespace weft::solve
