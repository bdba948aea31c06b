// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "library/batch/outcome.h"

namespace weft::library {

struct RunBatchOptions {
  std::filesystem::path plan;
  std::optional<int> task = {};  ///< none: all of them
  int jobs = 1;                  ///< sessions at a time, which share the threads
  bool retry_failed = false;
  std::vector<std::string> keep = {};  ///< in place of the plan's; empty: as planned
  bool half = false;                   ///< though the plan does not say so
  std::string fetch, store;            ///< commands with {src} and {dst}; empty: none
  std::filesystem::path scratch = {};  ///< where fetched sessions go; empty: the system's temporary folder
  std::optional<double> memory_mb;     ///< of a session at most; none: as much as there is

  std::uint64_t memory_bytes() const { return static_cast<std::uint64_t>(memory_mb.value_or(0) * (1 << 20)); }
};

/// What `weft batch run` and its job are told.
struct RunBatchRequest {
  RunBatchOptions options;
  std::optional<int> array_from;  ///< `task` is this more than the index of the array that Slurm runs
  bool merges = false;            ///< the report is written afterwards
};
void describe(Fields& fields, RunBatchRequest& request);

struct RunBatchReport {
  int kept = 0;           ///< sessions that were done before
  int kept_failures = 0;  ///< that failed before and were not tried again
  int solved = 0, there = 0, failed = 0, lost = 0;
  int not_begun = 0;  ///< it was stopped before
  bool was_stopped = false;
  std::vector<ErrorKind> failures, losses;  ///< of failed sessions, those kept among them, and of lost ones
  double seconds = 0;

  bool is_whole() const { return failed + kept_failures + lost + not_begun == 0; }
};

/// Called after each session, with the hours that are still to come.
using AfterSession = std::function<void(const TaskOutcome& outcome, double hours_left)>;

/// Solves the sessions of a plan, or of one of its tasks, that have no result yet, each in a process of its
/// own (forked_work.h): a session that runs out of memory, crashes or is killed is lost alone, is no result,
/// and is done again by the next run. It takes no lock and needs nobody: solves are published whole, and each
/// result is a line of its task's file beside the plan. While a session is solved the next one is fetched, or
/// read once so that the system has it in memory. A stop ends the session in hand, or lets it finish where
/// that is a matter of seconds. This process gives way to others.
///
/// Errors: of the plan, kUsage for what does not go together, kCannotCreate and kInputOutput where results
/// cannot be written.
Result<RunBatchReport> run_batch(const RunBatchOptions& options, const JobContext& context,
                                 const AfterSession& after);

}  // namespace weft::library
