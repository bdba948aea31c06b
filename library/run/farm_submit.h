// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "library/batch/farm.h"
#include "library/run/plan_file.h"

// A batch on a cluster that Slurm shares out. What is done is told by the folders of solves, never by Slurm.

namespace weft::library {

struct SubmitOptions {
  std::filesystem::path plan;
  FarmOptions farm;
  bool dry_run = false;  ///< only say what would be submitted
};

struct SbatchCall {
  std::string job;                   ///< number that Slurm gave; empty where it was not called
  TaskArray array;                   ///< none of the merge
  std::vector<std::string> command;  ///< sbatch and its arguments
};

struct SubmitReport {
  std::vector<SbatchCall> arrays;
  std::optional<SbatchCall> merge;
  FarmQueue queued;  ///< before
  int missing = 0;   ///< tasks with a session without result
};

/// Submits the tasks that have a session without a result and that are not queued, as arrays, and the report
/// after all that are queued then. Done again it submits nothing twice: it asks Slurm for jobs of this plan's
/// name first. With at_once arrays run one after the other.
///
/// Errors of read_batch(); kUsage where nodes are asked for nonsense; kNoInput where there is no Slurm;
/// kTryAgain with its words where it refuses, after what was submitted before.
Result<SubmitReport> submit_batch(const SubmitOptions& options);

/// What is queued and runs; nothing where the plan was never submitted, or this machine
/// has no Slurm. kTryAgain where it does not answer.
Result<std::optional<FarmQueue>> queue_of_batch(const PlanFile& plan);

/// Ends what is queued and runs of a plan; how many jobs and tasks. What is solved stays. Errors as above.
Result<FarmQueue> cancel_batch(const std::filesystem::path& plan);

/// The task that Slurm started this process for, of an array whose index 0 is task `first`. kUsage outside of
/// an array.
Result<int> task_of_array(int first);

/// Has Slurm queue the task of this process again, unless it was cancelled or that was done too often; true
/// where it did. Slurm ends this process then.
Result<bool> requeue_own_task();

}  // namespace weft::library
