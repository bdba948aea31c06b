// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "batch/plan.h"
#include "core/job.h"
#include "core/result.h"

// What a plan has made of each solve: maps and exports.

namespace weft::app {

/// A solve, where it lies, and the calibration that its session was solved by; empty: its own.
struct SolveOfSession {
  std::filesystem::path session, solve, calibration;
};

/// Makes what the product asks for of a solve, in its session; returns the folders. Errors of make_maps() and
/// export_maps().
Result<std::vector<std::string>> make_follow_ups(const SolveOfSession& of, const batch::Product& product,
                                                 const JobContext& context);

}  // namespace weft::app
