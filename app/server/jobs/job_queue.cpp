// SPDX-License-Identifier: Apache-2.0
#include "app/server/jobs/job_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/error_json.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJobSchema = "weft.job";
constexpr auto kLook = std::chrono::milliseconds(100);
constexpr double kPatience_s = 10;                   // for a cancelled job to put away what it has begun
constexpr double kCountdown_s = 1;                   // what is left is told this often, whatever a job says
constexpr int kWarningsCode = 2, kBadDataCode = 65;  // of verbs
constexpr int kSignalled = 128;                      // and above: with the signal that ended the process
constexpr std::size_t kMostNotes = 50, kLongestNote = 1000;

bool has_ended(JobState state) {
  return state != JobState::kQueued && state != JobState::kRunning;
}

Error no_job(const std::string& id) {
  return {ErrorKind::kNoInput, "there is no such job", id.substr(0, 20), "", "see the list of jobs"};
}

Error not_now(const JobStatus& job, const char* what, const char* remedy) {
  return {ErrorKind::kUsage, what, job.id, fmt::format("it is {}", name_of(job.state)), remedy};
}

std::string bytes_from(const fs::path& file, std::size_t at) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(at));
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

// The document that a verb printed; null where it printed none.
Json printed(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  const Json document = text ? Json::parse(*text, nullptr, false) : Json();
  return document.is_discarded() ? Json() : document;
}

std::optional<double> number_in(const Json& object, const char* key) {
  const Json value = object.is_object() ? object.value(key, Json()) : Json();
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

/// What became of a job by how its process ended. What was finished before it could be stopped is done.
void judge(JobStatus& job, Json result, bool is_cancelled, bool is_stopped) {
  // A check that found something has an answer.
  const bool is_answered = job.exit_code == kBadDataCode && job.error.is_null() && result.is_object();
  if (job.exit_code == 0 || job.exit_code == kWarningsCode || is_answered) {
    job.state = JobState::kDone;
    job.result = std::move(result);
  } else if (is_cancelled) {
    job.state = JobState::kCancelled;
  } else if (is_stopped) {
    job.state = JobState::kQueued;
  } else {
    job.state = JobState::kFailed;
    job.result = std::move(result);
    if (!job.error.is_null()) return;
    const int code = job.exit_code.value_or(-1);
    job.error = weft::json_of(
        Error{ErrorKind::kInternal, "job ended without a word", job.spec.kind,
              fmt::format("exit code {}{}{}", code, job.notes.empty() ? "" : ": ",
                          job.notes.empty() ? "" : job.notes.back()),
              code > kSignalled ? "its memory limit may have ended it: try a cheaper level" : "see its log"});
  }
}

}  // namespace

Result<std::unique_ptr<JobQueue>> JobQueue::open(JobQueueOptions options) {
  if (Result<void> ok = make_writable_folder(options.folder); !ok) return std::move(ok).error();
  std::unique_ptr<JobQueue> queue(new JobQueue(std::move(options)));
  if (Result<void> ok = queue->load(); !ok) return std::move(ok).error();
  queue->worker_ = std::jthread([q = queue.get()](const std::stop_token& stop) { q->work(stop); });
  return queue;
}

JobQueue::~JobQueue() {
  worker_.request_stop();
  woken_.notify_all();
  if (worker_.joinable()) worker_.join();
}

Result<void> JobQueue::load() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(options_.folder, error)) {
    if (entry.path().extension() != ".json") continue;
    const Result<Json> document = read_json(entry.path(), kJobSchema, 1);
    if (!document) continue;
    Result<JobStatus> job = job_from_json(*document, entry.path().string());
    if (!job || job->id != entry.path().stem()) continue;
    int number = 0;
    std::from_chars(job->id.data(), job->id.data() + job->id.size(), number);
    last_ = std::max(last_, number);
    jobs_[job->id] = std::move(*job);
  }
  if (error) return cannot_read(options_.folder, error.value());
  for (auto& [id, job] : jobs_) {
    if (job.state == JobState::kQueued) waiting_.push_back(id);
  }
  for (auto& [id, job] : jobs_) {
    if (job.state != JobState::kRunning) continue;
    job.state = JobState::kQueued;
    waiting_.insert(waiting_.begin(), id);
  }
  return {};
}

fs::path JobQueue::file_of(const std::string& id, const char* ending) const {
  return options_.folder / (id + ending);
}

Result<void> JobQueue::write(const JobStatus& job) const {
  return write_json(file_of(job.id, ".json"), document_of(job));
}

Result<JobStatus> JobQueue::add(const JobSpec& spec) {
  const std::lock_guard lock(mutex_);
  if (!spec.request_id.empty()) {
    for (const auto& [id, job] : jobs_) {
      if (job.spec.request_id == spec.request_id) return job;
    }
  }
  JobStatus job;
  job.id = fmt::format("{:06}", ++last_);
  job.spec = spec;
  job.asked = iso_time_now();
  if (Result<void> ok = write(job); !ok) return std::move(ok).error();
  jobs_[job.id] = job;
  waiting_.push_back(job.id);
  options_.changed(job);
  woken_.notify_all();
  return job;
}

std::vector<JobStatus> JobQueue::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<JobStatus> jobs;
  for (const auto& [id, job] : jobs_) jobs.push_back(as_it_stands(job));
  std::ranges::reverse(jobs);
  return jobs;
}

Result<JobStatus> JobQueue::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return no_job(id);
  return as_it_stands(found->second);
}

JobStatus JobQueue::as_it_stands(JobStatus job) const {
  const auto waits = std::ranges::find(waiting_, job.id);
  if (waits != waiting_.end()) job.place = static_cast<int>(waits - waiting_.begin()) + 1;
  return job;
}

Result<std::string> JobQueue::log(const std::string& id) const {
  const Result<JobStatus> job = find(id);
  if (!job) return job.error();
  return bytes_from(file_of(id, ".log"), 0);
}

Result<JobStatus> JobQueue::cancel(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return no_job(id);
  JobStatus& job = found->second;
  if (has_ended(job.state)) return not_now(job, "job cannot be cancelled", "retry begins it anew");
  if (job.state == JobState::kRunning) {
    is_cancelled_ = true;
    woken_.notify_all();
    return job;
  }
  JobStatus ended = job;
  ended.state = JobState::kCancelled;
  ended.ended = iso_time_now();
  if (Result<void> ok = write(ended); !ok) return std::move(ok).error();
  job = ended;
  std::erase(waiting_, id);
  options_.changed(job);
  return job;
}

Result<JobStatus> JobQueue::retry(const std::string& id) {
  const Result<JobStatus> job = find(id);
  if (!job) return job;
  if (!has_ended(job->state)) return not_now(*job, "job cannot be retried", "cancel it first, or wait");
  JobSpec spec = job->spec;
  spec.request_id.clear();
  return add(spec);
}

Result<JobStatus> JobQueue::first(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return no_job(id);
  if (found->second.state != JobState::kQueued) return not_now(found->second, "job does not wait", "");
  std::erase(waiting_, id);
  waiting_.insert(waiting_.begin(), id);
  options_.changed(found->second);
  return found->second;
}

Result<JobStatus> JobQueue::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return no_job(id);
  JobStatus job = found->second;
  if (!has_ended(job.state)) return not_now(job, "job cannot be forgotten", "cancel it first, or wait");
  remove_files(id);
  jobs_.erase(found);
  return job;
}

void JobQueue::remove_files(const std::string& id) const {
  std::error_code ignored;
  for (const char* ending : {".json", ".log", ".out"}) fs::remove(file_of(id, ending), ignored);
  fs::remove_all(files_of(id), ignored);
}

void JobQueue::hold(bool is_held) {
  const std::lock_guard lock(mutex_);
  if (is_held_ == is_held) return;
  is_held_ = is_held;
  if (child_) {
    signal_all(is_held ? SIGSTOP : SIGCONT);
    JobStatus& job = jobs_[running_];
    job.is_held = is_held;
    options_.changed(job);
  }
  woken_.notify_all();
}

// To the running job with the processes that it started.
void JobQueue::signal_all(int number) const {
  ::kill(-child_->pid(), number);
}

void JobQueue::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::string next;
    {
      std::unique_lock lock(mutex_);
      woken_.wait(lock, stop, [&] { return !waiting_.empty() && !is_held_; });
      if (stop.stop_requested()) return;
      next = waiting_.front();
      waiting_.erase(waiting_.begin());
    }
    run(next, stop);
  }
}

// What the job needs and is gone; empty where all is there.
std::string JobQueue::missing(const std::string& id) const {
  const Result<JobStatus> job = find(id);  // a copy: its disk may hang
  if (!job) return "";
  const auto gone =
      std::ranges::find_if_not(job->spec.needs, [](const std::string& need) { return is_there(need); });
  return gone == job->spec.needs.end() ? "" : *gone;
}

// The argument with the folder of the job's files, which is made for a file in it.
std::string JobQueue::with_files(const std::string& argument, const std::string& id) const {
  if (!argument.starts_with(kJobFiles)) return argument;
  const std::string below = argument.substr(std::string_view(kJobFiles).size());
  std::error_code ignored;
  if (!below.empty()) fs::create_directories(files_of(id), ignored);
  return files_of(id).string() + below;
}

void JobQueue::fail(JobStatus& job, const Error& error) {
  job.state = JobState::kFailed;
  job.error = weft::json_of(error);
  job.ended = iso_time_now();
  (void)write(job);
  options_.changed(job);
}

void JobQueue::run(const std::string& id, const std::stop_token& stop) {
  const std::string gone = missing(id);
  std::unique_lock lock(mutex_);
  JobStatus& job = jobs_[id];
  if (!gone.empty()) {
    return fail(job, {ErrorKind::kNoInput, "what the job works on is gone", gone,
                      "it was there when the job was asked for", "bring it back, then retry"});
  }
  std::vector<std::string> command = {options_.program.string()};
  for (const std::string& argument : job.spec.arguments) command.push_back(with_files(argument, id));
  std::ranges::move(foretold(job.spec), std::back_inserter(command));
  command.insert(command.end(), {"--json", "--json-events"});
  const fs::path output = file_of(id, ".out");
  Result<std::unique_ptr<ChildProcess>> started =
      ChildProcess::start({.command = std::move(command),
                           .output = output,
                           .errors = file_of(id, ".log"),
                           .group = ProcessGroup::kOwnSession,
                           .ends_with_parent = true,
                           .niceness = options_.niceness,
                           .memory_bytes = options_.memory_bytes});
  job.began = iso_time_now();
  job.phase.clear();
  job.share = 0;
  if (!started) return fail(job, started.error());
  job.state = JobState::kRunning;
  (void)write(job);
  options_.changed(job);
  child_ = std::move(*started);
  running_ = id;
  if (is_held_) signal_all(SIGSTOP);

  std::optional<double> expected_s = expected_seconds(job.spec);
  auto looked = std::chrono::steady_clock::now();
  bool was_held = is_held_;
  job.seconds = 0;
  std::size_t read = 0;
  std::optional<std::chrono::steady_clock::time_point> told;  // to end
  while (child_->runs()) {
    if ((is_cancelled_ || stop.stop_requested()) && !told) {
      signal_all(SIGCONT);
      child_->signal(SIGTERM);
      told = std::chrono::steady_clock::now();
    }
    if (told && std::chrono::steady_clock::now() - *told > std::chrono::duration<double>(kPatience_s))
      child_->signal(SIGKILL);
    woken_.wait_for(lock, kLook);
    const auto now = std::chrono::steady_clock::now();
    if (!was_held) job.seconds += std::chrono::duration<double>(now - looked).count();
    looked = now;
    was_held = is_held_;
    follow(id, read, expected_s);
  }
  ::kill(-child_->pid(), SIGKILL);  // what it has started ends with it
  expected_s.reset();
  follow(id, read, expected_s);
  job.exit_code = child_->wait(0);
  child_.reset();
  running_.clear();
  job.is_held = false;
  job.left_s.reset();
  judge(job, printed(output), std::exchange(is_cancelled_, false), stop.stop_requested());
  if (job.state != JobState::kQueued) job.ended = iso_time_now();
  (void)write(job);
  options_.changed(job);
  forget_old();
}

// By the newest price of its session, else by the newest job that is done and differs in nothing but what it
// worked on.
std::optional<double> JobQueue::expected_seconds(const JobSpec& spec) const {
  if (const Json planned = spec.wants.value(kPlannedSeconds, Json()); planned.is_number())
    return planned.get<double>();
  if (const Json level = priced_level(spec); !level.is_null()) return number_in(level["seconds"], "total");
  const auto same = [](const std::string& a, const std::string& b) {
    return a == b || (a.starts_with('/') && b.starts_with('/'));
  };
  for (auto it = jobs_.rbegin(); it != jobs_.rend(); ++it) {
    const JobStatus& job = it->second;
    if (job.state == JobState::kDone && job.spec.kind == spec.kind &&
        std::ranges::equal(job.spec.arguments, spec.arguments, same)) {
      return job.seconds;
    }
  }
  return std::nullopt;
}

// What the newest price of its session says of the level that a solve is to be of; null where there is none.
Json JobQueue::priced_level(const JobSpec& spec) const {
  const Json quality = spec.wants.is_object() ? spec.wants.value("quality", Json()) : Json();
  if (spec.kind != "solve" || !quality.is_string()) return {};
  for (auto it = jobs_.rbegin(); it != jobs_.rend(); ++it) {
    const JobStatus& job = it->second;
    if (job.spec.kind != "price" || job.spec.of != spec.of || !job.result.is_object()) continue;
    for (const Json& level : job.result.value("levels", Json::array())) {
      if (level.is_object() && level.value("quality", Json()) == quality &&
          number_in(level.value("seconds", Json()), "total"))
        return level;
    }
  }
  return {};
}

// So that the solve keeps what its price said; empty where there was none.
std::vector<std::string> JobQueue::foretold(const JobSpec& spec) const {
  if (spec.wants.contains("calibration")) return {};  // not that of the price
  const Json level = priced_level(spec);
  const std::optional<double> degrees = number_in(level, "predicted_deg"),
                              solved = number_in(level, "solved");
  if (!degrees || !solved) return {};
  const Json& seconds = level["seconds"];
  const double until_written = *number_in(seconds, "total") - number_in(seconds, "sync").value_or(0);
  return {"--foretold", fmt::format("{},{},{}", until_written, *degrees, *solved)};
}

// Reads what the verb has said since, and counts down what is left.
void JobQueue::follow(const std::string& id, std::size_t& read, std::optional<double>& expected_s) {
  JobStatus& job = jobs_[id];
  const double share_before = job.share;
  const std::string said = bytes_from(file_of(id, ".log"), read);
  const std::size_t whole = said.rfind('\n') + 1;
  read += whole;
  std::istringstream lines(said.substr(0, whole));
  for (std::string line; std::getline(lines, line);) hear(job, line);
  // What is planned beforehand has one phase, whose share is one of seconds.
  if (expected_s && job.spec.wants.contains(kPlannedSeconds) && job.share > share_before)
    expected_s = job.seconds / job.share;
  const double left_s = expected_s.value_or(0) - job.seconds;
  const bool is_told = whole > 0 || (job.left_s && *job.left_s - left_s >= kCountdown_s);
  if (!is_told) return;
  job.left_s = left_s > 0 ? std::optional(left_s) : std::nullopt;
  options_.changed(job);
}

void JobQueue::hear(JobStatus& job, const std::string& line) {
  // A library may have written a line of its own between them.
  Json event = Json::parse(line, nullptr, false);
  const auto text = [&](const char* key) {
    const Json value = event.is_object() ? event.value(key, Json()) : Json();
    return value.is_string() ? value.get<std::string>() : std::string();
  };
  const std::string kind = text("event");
  if (kind == "progress") {
    job.phase = text("phase");
    const Json share = event.value("share", Json());
    job.share = share.is_number() ? share.get<double>() : 0;
  } else if (kind == "error") {
    event.erase("event");
    job.error = std::move(event);
  } else if (kind != "end" && job.notes.size() < kMostNotes) {
    job.notes.push_back(kind == "note" ? text("text") : line.substr(0, kLongestNote));
  }
}

void JobQueue::forget_old() {
  std::size_t ended = 0;
  for (auto it = jobs_.rbegin(); it != jobs_.rend(); ++it) ended += has_ended(it->second.state);
  for (auto it = jobs_.begin(); it != jobs_.end() && ended > options_.most_remembered;) {
    if (!has_ended(it->second.state)) {
      ++it;
      continue;
    }
    remove_files(it->first);
    it = jobs_.erase(it);
    --ended;
  }
}

}  // namespace weft::app
