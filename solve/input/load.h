// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "solve/photographs/photographs.h"
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

/// Bytes that decoding and solving will hold at once: the frames, one more for every thread that decodes,
/// bands, and what the level keeps of the whole frame.
std::uint64_t memory_needed(const SolvePlan& plan, int threads);

/// What is planned, in memory and ready to be solved: every frame is decoded once, those of a session after a
/// look at their digests, and what they say of their own exposures is put right
/// (solve/conditions/conditions.h). Readings outside a mask are missing. The frames of one pose are there at
/// a time. kTryAgain where the memory is too small; errors of frames and of conditions.
Result<Photographs> load_photographs(const SolvePlan& plan, const JobContext& context);

}  // namespace weft::solve
