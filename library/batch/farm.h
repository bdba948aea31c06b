// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "library/batch/plan.h"

// A batch as array jobs of Slurm (manual pages sbatch, squeue and slurm.conf of 22.05): what is asked of its
// programs, and what is read from what they say. Nothing is run here.

namespace weft::library {

/// One word of a command, quoted for a shell where it must be.
std::string shell_word(const std::string& text);

/// What one cluster takes at most.
struct FarmLimits {
  int array_size = 1001;  ///< MaxArraySize: every index of an array lies below it
  int jobs = 10000;       ///< MaxJobCount: tasks that may be queued at once

  friend bool operator==(const FarmLimits&, const FarmLimits&) = default;
};
/// Reads `scontrol show config`; Slurm's own defaults where it does not say.
FarmLimits limits_from(std::string_view config);

struct FarmOptions {
  std::string partition = {}, account = {}, qos = {};
  int at_once = 0;                     ///< tasks; 0: as many as the cluster gives
  int cores = 1;                       ///< of a task
  std::vector<std::string> more = {};  ///< further arguments of sbatch
};

/// Tasks of one array job, of about equal memory.
struct TaskArray {
  int first = 0;           ///< the task of index 0
  std::vector<int> tasks;  ///< rising
  std::uint64_t memory_bytes = 0;
  int minutes = 0;  ///< after which Slurm ends a task

  friend bool operator==(const TaskArray&, const TaskArray&) = default;
};

/// Twice what is expected of the task with so many cores, and five minutes.
int asked_minutes(double expected_s, int expected_threads, int cores);

/// The tasks, rising, as array jobs: tasks whose memory is within a power of two share one, and no index
/// reaches what the cluster takes.
std::vector<TaskArray> arrays_of(const BatchHeader& header, std::span<const int> tasks, int cores,
                                 const FarmLimits& limits);

/// "0-3,7": indices of an array, as sbatch reads them.
std::string indices_of(const TaskArray& array);

/// Where a batch lies, as nodes see it.
struct FarmPlaces {
  std::string program, plan, results;  ///< weft, the plan, and its folder of results
};

/// sbatch with all its arguments for one array; it prints the job's number. `after`: numbers of jobs that end
/// before it begins.
std::vector<std::string> array_command(const BatchHeader& header, const TaskArray& array,
                                       const FarmOptions& options, const FarmPlaces& places,
                                       std::span<const std::string> after);
/// The same for the report, once these have ended in whatever way.
std::vector<std::string> merge_command(const BatchHeader& header, const FarmOptions& options,
                                       const FarmPlaces& places, std::span<const std::string> after);

/// The number of a job in what `sbatch --parsable` printed. kProtocol.
Result<std::string> job_from(std::string_view said);

/// squeue with its arguments for this batch.
std::vector<std::string> queue_command(const BatchHeader& header);

/// A task that Slurm has queued or runs.
struct QueuedTask {
  int task = 0;
  std::string job;     ///< number of the array
  std::string state;   ///< "RUNNING"
  std::string reason;  ///< why it waits: "BeginTime"
};

struct FarmQueue {
  std::vector<QueuedTask> tasks;
  std::vector<std::string> merges;  ///< numbers of jobs

  int count(std::string_view state) const;
  std::vector<std::string> jobs() const;  ///< numbers of arrays, each once
};
/// What squeue printed; lines of other batches are left out.
FarmQueue queue_from(std::string_view said, const BatchHeader& header);

/// Tasks that are neither done nor queued, of those without a result.
std::vector<int> not_queued(std::span<const int> missing, const FarmQueue& queue);

/// So many times a task that was stopped queues itself again.
inline constexpr int kMostRequeues = 3;

/// Whether a task that ended with 75 is to queue itself again: Slurm takes it for running (it is not one that
/// was cancelled, or that Slurm queues again by itself), and it has not done so too often.
bool is_to_be_requeued(std::string_view state, int restarts);

}  // namespace weft::library
