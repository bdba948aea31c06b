// SPDX-License-Identifier: Apache-2.0
#include "library/run/farm_submit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "core/base/files.h"
#include "core/base/process.h"
#include "core/base/temporary_folder.h"
#include "library/run/merge_batch.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr double kMostToAnswer_s = 300;  // sbatch waits for a controller that is away, and so do we
constexpr const char* kLogs = "log";     // below the results: what tasks print

// What a program of Slurm prints.
Result<std::string> ask_slurm(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  const fs::path output = folder.path() / "output", errors = folder.path() / "errors";
  const Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(words, {}, output, errors);
  if (!child) {
    return Error{ErrorKind::kNoInput, "there is no Slurm on this machine", words.front(),
                 "its programs are not on $PATH",
                 "run it where jobs are submitted, or give a farm the lines of weft batch commands"};
  }
  const std::optional<int> code = (*child)->wait(kMostToAnswer_s);
  if (!code) {
    return Error{ErrorKind::kTryAgain, "Slurm does not answer", words.front(),
                 fmt::format("{:.0f} seconds are over", kMostToAnswer_s), "look at scontrol ping"};
  }
  if (code == 0) return read_text(output);
  const Result<std::string> said = read_text(errors);
  std::string why = said ? said->substr(0, 1000) : "";
  while (why.ends_with('\n')) why.pop_back();
  return Error{ErrorKind::kTryAgain, "Slurm refuses", fmt::format("{}", fmt::join(words, " ")), why,
               "what was submitted before stays: mend that, then run the same command again"};
}

std::optional<int> number_in_environment(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return {};
  const std::string_view digits = text;
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size()) return {};
  return number;
}

Result<FarmQueue> ask_for_queue(const BatchHeader& header) {
  const Result<std::string> said = ask_slurm(queue_command(header));
  if (!said) return said.error();
  return queue_from(*said, header);
}

Result<void> check_farm_options(const FarmOptions& options) {
  if (options.cores >= 1 && options.at_once >= 0) return {};
  return Error{ErrorKind::kUsage, "batch cannot be submitted so", "--cores, --at-once",
               fmt::format("{} cores, {} at once", options.cores, options.at_once), "give a task one core"};
}

// A batch on its way into the queue.
class Submission {
 public:
  Submission(const SubmitOptions& options, BatchState state)
      : options_(options), state_(std::move(state)), header_(state_.plan.header) {
    places_ = {program_beside("weft").string(), state_.file.file.string(), state_.file.results().string()};
  }

  Result<SubmitReport> submit() {
    Result<FarmQueue> queue = ask_for_queue(header_);
    if (!queue) return std::move(queue).error();
    report_.queued = std::move(*queue);
    report_.missing = static_cast<int>(state_.summary.missing_tasks.size());
    jobs_ = report_.queued.jobs();
    const std::vector<int> tasks = not_queued(state_.summary.missing_tasks, report_.queued);
    if (!tasks.empty()) {
      if (Result<void> ok = submit_arrays(tasks); !ok) return std::move(ok).error();
    }
    const bool has_merge = !report_.queued.merges.empty();
    if (!report_.arrays.empty() || (!jobs_.empty() && !has_merge)) {
      SbatchCall merge = {"", {}, merge_command(header_, options_.farm, places_, jobs_)};
      if (Result<void> ok = send(merge); !ok) return std::move(ok).error();
      report_.merge = std::move(merge);
    }
    return std::move(report_);
  }

 private:
  Result<void> submit_arrays(const std::vector<int>& tasks) {
    const Result<std::string> config = ask_slurm({"scontrol", "show", "config"});
    if (!config) return config.error();
    // Slurm does not make the folder of what a task prints.
    if (Result<void> made = make_writable_folder(state_.file.results() / kLogs); !made) return made;
    const FarmLimits limits = limits_from(*config);
    for (TaskArray& array : arrays_of(header_, tasks, options_.farm.cores, limits)) {
      const std::vector<std::string> after = options_.farm.at_once > 0 ? jobs_ : std::vector<std::string>();
      SbatchCall call = {"", array, array_command(header_, array, options_.farm, places_, after)};
      if (Result<void> ok = send(call); !ok) return ok;
      if (!call.job.empty()) jobs_.push_back(call.job);
      report_.arrays.push_back(std::move(call));
    }
    return {};
  }

  Result<void> send(SbatchCall& call) const {
    if (options_.dry_run) return {};
    const Result<std::string> said = ask_slurm(call.command);
    if (!said) return said.error();
    Result<std::string> number = job_from(*said);
    if (!number) return std::move(number).error();
    call.job = std::move(*number);
    return {};
  }

  const SubmitOptions& options_;
  const BatchState state_;
  const BatchHeader& header_;
  FarmPlaces places_;
  std::vector<std::string> jobs_;  // arrays that are queued
  SubmitReport report_;
};

}  // namespace

Result<SubmitReport> submit_batch(const SubmitOptions& options) {
  if (Result<void> ok = check_farm_options(options.farm); !ok) return std::move(ok).error();
  Result<BatchState> state = read_batch(options.plan);
  if (!state) return std::move(state).error();
  return Submission(options, std::move(*state)).submit();
}

Result<std::optional<FarmQueue>> queue_of_batch(const PlanFile& plan) {
  if (!is_there(plan.results() / kLogs)) return std::optional<FarmQueue>();
  Result<FarmQueue> queue = ask_for_queue(plan.header);
  if (queue) return std::optional(std::move(*queue));
  if (queue.error().kind == ErrorKind::kNoInput) return std::optional<FarmQueue>();
  return std::move(queue).error();
}

Result<FarmQueue> cancel_batch(const fs::path& plan) {
  const Result<PlanFile> file = open_plan(plan);
  if (!file) return file.error();
  Result<FarmQueue> queue = ask_for_queue(file->header);
  if (!queue) return queue;
  std::vector<std::string> words = {"scancel"};
  for (const std::string& job : queue->jobs()) words.push_back(job);
  for (const std::string& job : queue->merges) words.push_back(job);
  if (words.size() == 1) return queue;
  if (const Result<std::string> said = ask_slurm(words); !said) return said.error();
  return queue;
}

Result<int> task_of_array(int first) {
  const std::optional<int> index = number_in_environment("SLURM_ARRAY_TASK_ID");
  if (index && *index >= 0) return first + *index;
  return Error{ErrorKind::kUsage, "there is no task", "SLURM_ARRAY_TASK_ID",
               "Slurm sets it for tasks of an array", "name a task by --task"};
}

Result<bool> requeue_own_task() {
  const char* const job = std::getenv("SLURM_JOB_ID");
  if (job == nullptr) return false;
  const Result<std::string> state = ask_slurm({"squeue", "--noheader", "--format=%T", "--jobs", job});
  if (!state) return state.error();
  if (!is_to_be_requeued(*state, number_in_environment("SLURM_RESTART_COUNT").value_or(0))) return false;
  if (const Result<std::string> said = ask_slurm({"scontrol", "requeue", job}); !said) return said.error();
  return true;
}

}  // namespace weft::library
