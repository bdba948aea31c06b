// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/job_context.h"
#include "library/batch/outcome.h"
#include "library/batch/plan.h"

namespace weft::library {

/// A session of a plan, and where it is worked on.
struct SessionWork {
  const BatchHeader* header = nullptr;
  PlannedSolve planned;
  BatchProduct product;           ///< what is kept
  std::filesystem::path session;  ///< where it is now: as planned, or fetched
  std::filesystem::path solves;   ///< its solves go here by their id
};

/// Solves a session as planned, keeps what is to be kept, makes what comes after it, and compares it with the
/// solve before: kSolved or kThere, or kFailed or kLost with the error. A session that is not where it was is
/// a kNoInput, one that was changed since the plan a kBadData, both by name. Whoever is second of two that
/// publish one solve finds it there.
TaskOutcome work_on_session(const SessionWork& work, const JobContext& context);

/// An outcome that an error ended: a failure where it is of the session, else no result.
TaskOutcome ended_by(const SessionWork& work, Error error);

}  // namespace weft::library
