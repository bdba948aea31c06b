// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "core/rig/photosites.h"
#include "solve/photographs/photographs.h"
#include "solve/photographs/solve_plan.h"

// What photographs say of their own exposures, and what is made of it before they are solved
// (docs/conditions.md). A condition is a file of this folder: what finds it, what puts it right, and what is
// said of it.

namespace weft::solve {

/// What a plan has beyond the shots that are solved, in its order.
struct FramesBeside {
  Frames repeats;
  std::vector<RawFrame> brackets;
  std::optional<Frames> blade;
  std::vector<Photosite> known_bad;  ///< that the calibration names
};

/// What a condition is found in, and what it changes: photographs, and in them what is said of it.
struct Exposures {
  const SolvePlan& plan;
  FramesBeside& beside;
  Photographs& photographs;
  const JobContext& context;
};

/// Each condition in its turn. The photographs are as they were decoded, those of a pair whole. Errors: those
/// of the conditions.
Result<void> meet_conditions(const Exposures& exposures);

}  // namespace weft::solve
