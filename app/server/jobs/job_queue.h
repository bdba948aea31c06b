// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/server/jobs/job.h"
#include "core/base/process.h"
#include "core/base/result.h"

namespace weft::app {

struct JobQueueOptions {
  std::filesystem::path folder;       ///< where jobs are remembered, a file each
  std::filesystem::path program;      ///< weft
  std::uint64_t memory_bytes = 0;     ///< that one job may hold (RLIMIT_DATA); 0: as much as there is
  int niceness = 10;                  ///< 0 to 19
  std::size_t most_remembered = 200;  ///< finished ones; the oldest are forgotten
  /// Hears of every change, from any thread, and must not call the queue.
  std::function<void(const JobStatus&)> changed = [](const JobStatus&) {};
};

/// Runs jobs one after another, each a child process that ends with this one, and remembers them: a browser
/// may close and the daemon restart. A job that ran when the daemon ended is queued again, as its first,
/// since what verbs make is named by its inputs and published whole. Safe from any thread.
class JobQueue {
 public:
  /// Makes the folder; files there that are no jobs are left alone. Errors: kCannotCreate, kInputOutput.
  static Result<std::unique_ptr<JobQueue>> open(JobQueueOptions options);
  /// Ends the running job, which is queued again next time.
  ~JobQueue();

  /// Queues a job, or finds the one of the same request. Errors: of writing its file.
  Result<JobStatus> add(const JobSpec& spec);
  /// All, the newest first.
  std::vector<JobStatus> list() const;
  /// kNoInput where there is none of this id.
  Result<JobStatus> find(const std::string& id) const;
  /// What its verb has printed on standard error, as lines of JSON.
  Result<std::string> log(const std::string& id) const;

  /// The folder of what it makes beside its result (kJobFiles), which need not be there.
  std::filesystem::path files_of(const std::string& id) const { return file_of(id, ".files"); }

  /// Ends a job, or takes it out of the queue; nothing of it is left. kUsage where it has ended.
  Result<JobStatus> cancel(const std::string& id);
  /// Queues it once more under a new id. kUsage where it has not ended.
  Result<JobStatus> retry(const std::string& id);
  /// Puts it before all others that wait. kUsage where it does not wait.
  Result<JobStatus> first(const std::string& id);
  /// Forgets one that has ended, with its files; how it was. kUsage where it has not ended.
  Result<JobStatus> forget(const std::string& id);
  /// While a scan exposes: the running job stands still, and none begins.
  void hold(bool is_held);

 private:
  explicit JobQueue(JobQueueOptions options) : options_(std::move(options)) {}
  Result<void> load();
  JobStatus as_it_stands(JobStatus job) const;
  void work(const std::stop_token& stop);
  std::string missing(const std::string& id) const;
  std::string with_files(const std::string& argument, const std::string& id) const;
  void fail(JobStatus& job, const Error& error);
  void run(const std::string& id, const std::stop_token& stop);
  std::optional<double> expected_seconds(const JobSpec& spec) const;
  Json priced_level(const JobSpec& spec) const;
  std::vector<std::string> foretold(const JobSpec& spec) const;
  void follow(const std::string& id, std::size_t& read, std::optional<double>& expected_s);
  void signal_all(int number) const;
  void hear(JobStatus& job, const std::string& line);
  void forget_old();
  void remove_files(const std::string& id) const;
  std::filesystem::path file_of(const std::string& id, const char* ending) const;
  Result<void> write(const JobStatus& job) const;

  JobQueueOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable_any woken_;
  std::map<std::string, JobStatus> jobs_;
  std::vector<std::string> waiting_;  // ids, the next first
  std::unique_ptr<ChildProcess> child_;
  std::string running_;        // id, or empty
  bool is_cancelled_ = false;  // the running one is to end
  bool is_held_ = false;
  int last_ = 0;  // number of the newest job
  std::jthread worker_;
};

}  // namespace weft::app
