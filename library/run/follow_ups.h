// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "library/batch/plan.h"
#include "library/run/survey.h"

// What a plan has made of each solve: maps and exports.

namespace weft::library {

/// A solve, where it lies, and the calibration that its session was solved by; empty: its own.
struct SolveOfSession {
  std::filesystem::path session, solve, calibration;
};

/// Makes what the product asks for of a solve, in its session; returns the folders. Errors of make_maps() and
/// export_maps().
Result<std::vector<std::string>> make_follow_ups(const SolveOfSession& of, const BatchProduct& product,
                                                 const JobContext& context);

/// What follow-ups take of a solve of the whole frame, whichever level made it.
struct FollowUpPrice {
  double megapixels = 0, seconds = 0;
  std::uint64_t memory_bytes = 0;  ///< that this process had at most meanwhile
  std::uint64_t write_bytes = 0;

  /// By pixels.
  FollowUpPrice of(double other_megapixels) const;
};

/// Makes them of a quick solve, of links to the session's files in the system's temporary folder, and takes
/// all of it away again. Errors of solve_session() and of make_follow_ups(), in which `where` is the session
/// and not the copy; that of a full disk names the temporary folder.
Result<FollowUpPrice> price_follow_ups(const Candidate& candidate, const BatchProduct& product,
                                       const JobContext& context);

}  // namespace weft::library
