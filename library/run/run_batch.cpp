// SPDX-License-Identifier: Apache-2.0
#include "library/run/run_batch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <utility>

#include "core/base/descriptor.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/partial_name.h"
#include "core/solve/solve.h"
#include "library/run/abandoned.h"
#include "library/run/forked_work.h"
#include "library/run/lean.h"
#include "library/run/outside.h"
#include "library/run/plan_batch.h"
#include "library/run/plan_file.h"
#include "library/run/session_work.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

constexpr int kPoll_ms = 100;
constexpr const char* kScratch = "weft-batch-";
constexpr double kMostToFinish_s = 20;   // Slurm's KillWait is 30
constexpr double kShareOfMemory = 0.25;  // that a session read ahead may take

// What a session is about to be: fetched, solved, stored.
enum class Stage { kFetch, kSolve, kStore, kReadAhead };

struct Active {
  Stage stage = Stage::kSolve;
  std::size_t item = 0;
  std::unique_ptr<ForkedWork> work;
  Steady::time_point began = Steady::now();
};

// A session under way.
struct Item {
  PlannedSolve planned;
  int attempt = 1;
  bool is_here = false;  // it can be solved
  bool is_read_ahead = false;
  bool is_over = false;
  fs::path fetched;  // its folder; empty: where it was planned
  std::optional<TaskOutcome> solved;
};

// Reads files so that the system keeps them in memory.
std::string read_ahead(const fs::path& session, const std::stop_token& stop) {
  std::vector<char> block(std::size_t{1} << 20);
  std::error_code failed;
  for (fs::recursive_directory_iterator entry(session / "raw", failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const Descriptor in(entry->path(), O_RDONLY);
    while (in && !stop.stop_requested() && ::read(in.get(), block.data(), block.size()) > 0) {
    }
  }
  return "";
}

class BatchRun {
 public:
  BatchRun(const RunBatchOptions& options, PlanFile plan, const JobContext& context,
           const AfterSession& after)
      : options_(options), plan_(std::move(plan)), context_(context), after_(after) {
    product_ = plan_.header.product;
    if (!options.keep.empty()) product_.keep = options.keep;
    product_.half = product_.half || options.half;
    scratch_ = (options.scratch.empty() ? fs::temp_directory_path() : absolute_folder(options.scratch)) /
               partial_name(kScratch + plan_.header.id);
  }
  ~BatchRun() {
    active_.clear();
    std::error_code ignored;
    if (!options_.fetch.empty()) fs::remove_all(scratch_, ignored);
  }
  BatchRun(const BatchRun&) = delete;
  BatchRun& operator=(const BatchRun&) = delete;

  Result<RunBatchReport> run() {
    Stopwatch watch;
    if (Result<void> ok = choose_items(); !ok) return std::move(ok).error();
    if (!items_.empty()) {
      if (!options_.fetch.empty()) clear_scratch();
      if (Result<void> ok = make_writable_folder(plan_.results()); !ok) return std::move(ok).error();
      if (Result<void> ok = work_through(); !ok) return std::move(ok).error();
    }
    report_.seconds = watch.lap();
    return std::move(report_);
  }

 private:
  bool is_stopped() const { return context_.stop.stop_requested(); }
  int threads() const { return std::max(1, resolved_threads(context_.threads) / std::max(1, options_.jobs)); }

  // What runs that were killed have fetched.
  void clear_scratch() const {
    std::vector<fs::path> left = abandoned_in(scratch_.parent_path());
    std::erase_if(left, [](const fs::path& folder) {
      return !folder.filename().string().starts_with("." + std::string(kScratch));
    });
    remove_folders(left);
  }

  // Whether a result of before still holds.
  bool holds(const TaskOutcome& result) const {
    if (result.state == TaskState::kFailed) return !options_.retry_failed;
    return result.is_stored || is_there(fs::path(result.folder) / kSolveProduct.document);
  }

  Result<void> choose_items() {
    std::vector<int> tasks;
    if (options_.task) tasks.push_back(*options_.task);
    for (int task = 0; !options_.task && task < static_cast<int>(plan_.header.tasks.size()); ++task)
      tasks.push_back(task);
    if (tasks.empty()) return {};
    const Result<std::map<std::string, TaskHistory>> histories = read_histories(plan_, tasks);
    if (!histories) return histories.error();
    for (const int task : tasks) {
      Result<std::vector<PlannedSolve>> solves = read_task(plan_, task);
      if (!solves) return std::move(solves).error();
      for (PlannedSolve& planned : *solves) add_item(std::move(planned), *histories);
    }
    return {};
  }

  void add_item(PlannedSolve planned, const std::map<std::string, TaskHistory>& histories) {
    Item item;
    const auto found = histories.find(planned.session);
    if (found != histories.end()) {
      const TaskHistory& history = found->second;
      item.attempt = history.attempts + 1;
      if (history.result && holds(*history.result)) {
        if (history.result->is_done()) {
          ++report_.kept;
        } else {
          ++report_.kept_failures;
          report_.failures.push_back(history.result->error ? history.result->error->kind
                                                           : ErrorKind::kBadData);
        }
        return;
      }
    }
    // With other maps kept than planned it is another solve.
    if (plan_.header.product.is_whole()) planned.solve = lean_id(planned.solve, product_);
    seconds_to_do_ += planned.forecast.seconds;
    seconds_in_all_ += planned.forecast.seconds;
    item.planned = std::move(planned);
    item.is_here = options_.fetch.empty();
    items_.push_back(std::move(item));
  }

  Result<void> work_through() {
    give_way();
    context_.progress("batch", 0);
    while (true) {
      if (!is_stopped()) {
        if (Result<void> ok = start_what_can_be(); !ok) return ok;
      }
      std::vector<const ForkedWork*> running;
      for (const Active& each : active_) {
        if (each.stage != Stage::kReadAhead) running.push_back(each.work.get());
      }
      if (running.empty()) break;
      ForkedWork::wait_for_any(running, kPoll_ms);
      if (Result<void> ok = take_what_ended(); !ok) return ok;
      if (is_stopped()) stop_all();
    }
    report_.was_stopped = is_stopped();
    report_.not_begun = static_cast<int>(items_.size()) - done_;
    return {};
  }

  std::size_t count(Stage stage) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(active_, [&](const Active& each) { return each.stage == stage; }));
  }

  Result<void> start_what_can_be() {
    const auto at_once = static_cast<std::size_t>(std::max(1, options_.jobs));
    // One ahead for each that is being solved, and no more: scratch is small.
    while (!options_.fetch.empty() && next_fetch_ < items_.size() &&
           next_fetch_ < next_solve_ + at_once + 1 && count(Stage::kFetch) < at_once) {
      if (Result<void> ok = start(Stage::kFetch, next_fetch_++); !ok) return ok;
    }
    while (next_solve_ < items_.size() && count(Stage::kSolve) < at_once) {
      // One that could not be fetched is over.
      if (!items_[next_solve_].is_here && !items_[next_solve_].is_over) break;
      const std::size_t index = next_solve_++;
      if (items_[index].is_over) continue;
      if (Result<void> ok = start(Stage::kSolve, index); !ok) return ok;
    }
    const bool has_next = next_solve_ < items_.size() && options_.fetch.empty();
    if (has_next && !items_[next_solve_].is_read_ahead && count(Stage::kReadAhead) == 0 &&
        static_cast<double>(items_[next_solve_].planned.read_bytes) <
            kShareOfMemory * static_cast<double>(available_memory_bytes())) {
      items_[next_solve_].is_read_ahead = true;
      return start(Stage::kReadAhead, next_solve_);
    }
    return {};
  }

  fs::path folder_of(const Item& item) const {
    return item.fetched.empty() ? fs::path(item.planned.session) : item.fetched;
  }

  SessionWork work_of(const Item& item) const {
    SessionWork work;
    work.header = &plan_.header;
    work.planned = item.planned;
    work.product = product_;
    work.session = folder_of(item);
    const bool is_fetched = !item.fetched.empty() && plan_.header.output.empty();
    work.solves =
        is_fetched ? item.fetched / "solve" : fs::path(solve_parent(plan_.header, item.planned.session));
    return work;
  }

  Result<void> start(Stage stage, std::size_t index) {
    Item& item = items_[index];
    std::function<std::string(std::stop_token)> work;
    if (stage == Stage::kFetch) {
      const fs::path to = scratch_ / std::to_string(index) / fs::path(item.planned.session).filename();
      if (Result<void> made = make_writable_folder(to.parent_path()); !made) return made;
      item.fetched = to;
      work = [this, &item, to](const std::stop_token&) {
        return run_outside(options_.fetch, item.planned.session, to.string());
      };
    } else if (stage == Stage::kSolve) {
      work = [this, &item](const std::stop_token& stop) {
        return line_of(work_on_session(work_of(item), {threads(), stop}));
      };
    } else if (stage == Stage::kStore) {
      const std::string to = solve_parent(plan_.header, item.planned.session) + "/" + item.solved->solve;
      work = [this, &item, to](const std::stop_token&) {
        return store_outside(options_.store, item.solved->folder, to);
      };
    } else {
      const fs::path session = item.planned.session;
      work = [session](const std::stop_token& stop) { return read_ahead(session, stop); };
    }
    Result<std::unique_ptr<ForkedWork>> started =
        ForkedWork::start(work, stage == Stage::kSolve ? options_.memory_bytes() : 0);
    if (!started) return std::move(started).error();
    active_.push_back({stage, index, std::move(*started), Steady::now()});
    return {};
  }

  Result<void> take_what_ended() {
    for (std::size_t i = 0; i < active_.size();) {
      std::optional<ForkedEnd> end = active_[i].work->ended();
      if (!end) {
        ++i;
        continue;
      }
      Active over = std::move(active_[i]);
      active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(i));
      if (Result<void> ok = take(over, std::move(*end)); !ok) return ok;
    }
    return {};
  }

  Result<void> take(const Active& over, ForkedEnd end) {
    Item& item = items_[over.item];
    switch (over.stage) {
      case Stage::kReadAhead:
        return {};
      case Stage::kFetch:
        item.is_here = end.signal == 0 && end.code == 0 && end.said.empty();
        if (item.is_here || is_stopped()) return {};
        return finish(over.item, ended_by(work_of(item), cannot_be(end, "session cannot be fetched", item)));
      case Stage::kSolve:
        return take_solved(over, std::move(end));
      case Stage::kStore: {
        if (end.signal == 0 && end.code == 0 && end.said.empty()) {
          TaskOutcome outcome = std::move(*item.solved);
          outcome.is_stored = true;
          outcome.folder = solve_parent(plan_.header, item.planned.session) + "/" + outcome.solve;
          return finish(over.item, std::move(outcome));
        }
        return finish(over.item, ended_by(work_of(item), cannot_be(end, "solve cannot be stored", item)));
      }
    }
    return {};
  }

  static Error cannot_be(const ForkedEnd& end, const char* what, const Item& item) {
    return {ErrorKind::kTryAgain, what, item.planned.session,
            end.signal != 0 ? fmt::format("its command was ended by signal {}", end.signal) : end.said,
            "look at the command, then run the same command again"};
  }

  Result<void> take_solved(const Active& over, ForkedEnd end) {
    Item& item = items_[over.item];
    std::optional<TaskOutcome> outcome;
    if (end.signal == 0 && end.code == 0) outcome = outcome_from_line(end.said);
    if (!outcome) outcome = ended_by(work_of(item), why_it_ended(end, item));
    outcome->peak_bytes = end.peak_bytes;
    if (outcome->seconds == 0)
      outcome->seconds = std::chrono::duration<double>(Steady::now() - over.began).count();
    outcome->node_seconds = outcome->seconds * threads() / std::max(1, plan_.header.threads);
    const SessionWork work = work_of(item);
    if (end.signal != 0 || end.code != 0) remove_folders(abandoned_of(work.session, work.solves));
    if (outcome->is_done() && !options_.store.empty()) {
      item.solved = std::move(outcome);
      return start(Stage::kStore, over.item);
    }
    return finish(over.item, std::move(*outcome));
  }

  Error why_it_ended(const ForkedEnd& end, const Item& item) const {
    const std::string limit =
        options_.memory_bytes() > 0 ? fmt::format("it may hold {} MB", options_.memory_bytes() >> 20) : "";
    if (end.code == ForkedWork::kOutOfMemory)
      return {ErrorKind::kTryAgain, "out of memory", item.planned.session, limit,
              "run it with more --memory, or on a larger machine"};
    if (end.signal != 0)
      return {ErrorKind::kTryAgain, "its process was killed", item.planned.session,
              fmt::format("signal {}{}", end.signal,
                          end.signal == SIGKILL ? ": the system was perhaps out of memory" : ""),
              "run the same command again"};
    return {ErrorKind::kInternal, "a bug in weft", item.planned.session, end.said,
            "report it with the command you ran"};
  }

  // Writes down what became of a session.
  Result<void> finish(std::size_t index, TaskOutcome outcome) {
    Item& item = items_[index];
    outcome.attempt = item.attempt;
    outcome.host = machine_name();
    item.is_over = true;
    if (Result<void> ok = add_outcome(plan_, item.planned.task, outcome); !ok) return ok;
    if (!item.fetched.empty()) {
      std::error_code ignored;
      fs::remove_all(item.fetched.parent_path(), ignored);
    }
    ++done_;
    seconds_to_do_ -= item.planned.forecast.seconds;
    if (outcome.state == TaskState::kSolved) {
      seconds_taken_ += outcome.node_seconds;
      seconds_foreseen_ += item.planned.forecast.seconds;
    }
    tally(outcome);
    context_.progress("batch", share_done());
    after_(outcome, hours_left());
    return {};
  }

  // The share of the seconds that were foreseen; where nothing was measured, of the sessions.
  double share_done() const {
    const double of_sessions = static_cast<double>(done_) / static_cast<double>(items_.size());
    return seconds_in_all_ > 0 ? std::clamp(1 - seconds_to_do_ / seconds_in_all_, 0.0, 1.0) : of_sessions;
  }

  // By the pace so far; where nothing was measured, as long as those that were done.
  double hours_left() const {
    const double share = static_cast<double>(plan_.header.threads) / (threads() * std::max(1, options_.jobs));
    const auto left = static_cast<double>(items_.size()) - done_;
    const double each_s = report_.solved > 0 ? seconds_taken_ / report_.solved : 0;
    const double seconds = seconds_foreseen_ > 0
                               ? std::max(0.0, seconds_to_do_) * seconds_taken_ / seconds_foreseen_
                               : left * each_s;
    return seconds * share / 3600;
  }

  void tally(const TaskOutcome& outcome) {
    const ErrorKind kind = outcome.error ? outcome.error->kind : ErrorKind::kTryAgain;
    switch (outcome.state) {
      case TaskState::kSolved:
        ++report_.solved;
        break;
      case TaskState::kThere:
        ++report_.there;
        break;
      case TaskState::kFailed:
        ++report_.failed;
        report_.failures.push_back(kind);
        break;
      case TaskState::kLost:
        ++report_.lost;
        report_.losses.push_back(kind);
        break;
    }
  }

  // Each is asked once, and killed where it takes its time.
  void stop_all() {
    if (!stop_asked_at_) {
      stop_asked_at_ = Steady::now();
      for (const Active& each : active_) {
        const bool can_end = each.stage == Stage::kSolve || each.stage == Stage::kStore;
        each.work->signal(can_end ? SIGTERM : SIGKILL);
      }
    }
    const double waited_s = std::chrono::duration<double>(Steady::now() - *stop_asked_at_).count();
    if (waited_s < kMostToFinish_s) return;
    for (const Active& each : active_) each.work->signal(SIGKILL);
  }

  const RunBatchOptions& options_;
  const PlanFile plan_;
  const JobContext& context_;
  const AfterSession& after_;
  BatchProduct product_;
  fs::path scratch_;
  std::vector<Item> items_;
  std::vector<Active> active_;
  std::size_t next_fetch_ = 0, next_solve_ = 0;
  int done_ = 0;
  double seconds_in_all_ = 0, seconds_to_do_ = 0, seconds_taken_ = 0, seconds_foreseen_ = 0;
  std::optional<Steady::time_point> stop_asked_at_;
  RunBatchReport report_;
};

Result<void> check_options(const RunBatchOptions& options, const BatchHeader& header) {
  const auto refused = [](const char* where, const char* why, const char* remedy) {
    return Error{ErrorKind::kUsage, "batch cannot be run so", where, why, remedy};
  };
  const bool is_other = !options.keep.empty() || options.half;
  if (is_other && !header.product.is_whole())
    return refused("--keep, --half", "the plan says which maps are kept", "run it without them");
  const bool is_lean = !header.product.is_whole() || !options.keep.empty() || options.half;
  if (!header.product.then.empty() && (is_lean || !options.fetch.empty()))
    return refused("--keep, --half, --fetch", "the plan makes maps of each solve, which want all of it",
                   "plan without --then");
  if (!options.store.empty() && !header.product.then.empty())
    return refused("--store", "the plan makes maps of each solve, which would stay here",
                   "plan without --then");
  if (!options.fetch.empty() && options.store.empty() && header.output.empty())
    return refused("--fetch", "solves would lie in scratch, which goes",
                   "name --store, or plan with --output");
  return {};
}

}  // namespace

void describe(Fields& fields, RunBatchRequest& r) {
  RunBatchOptions& o = r.options;
  fields.value({.name = "plan",
                .says = "Plan of weft batch plan",
                .need = kMustSay,
                .option = "",
                .said = Said::kAtThisMachine},
               o.plan);
  fields.value({.name = "task",
                .says = "One task of it, from 0; default all",
                .range = kNotNegative,
                .said = Said::kAtThisMachine},
               o.task);
  fields.value({.name = "at_once",
                .says = "Sessions at a time, which share the threads",
                .range = {1, 1024},
                .option = "--jobs"},
               o.jobs);
  fields.value({.name = "array_from",
                .says = "In an array of Slurm: the task that is so much more than its index. It is queued "
                        "again where it ends with 75, up to three times",
                .range = kNotNegative,
                .said = Said::kAtThisMachine},
               r.array_from);
  fields.value(
      {.name = "merge",
       .says = "Write the report afterwards, as weft batch merge does, and end with its exit code: 2 "
               "where a session failed or is missing. Not where it was stopped",
       .said = Said::kAtThisMachine},
      r.merges);
  for (const char* whole : {"at_once", "array_from", "merge"}) fields.exclude(whole, "task");
  fields.value({"retry_failed", "Try sessions again that failed before"}, o.retry_failed);
  describe_kept_maps(fields, o.keep, o.half);
  fields.value({.name = "fetch",
                .says = "Command that brings a session here before it is solved: 'rclone copy {src} {dst}'",
                .said = Said::kAtThisMachine},
               o.fetch);
  fields.value({.name = "store",
                .says = "Command that takes a solve away: all but solve.json, then solve.json alone as "
                        "{dst}/solve.json",
                .said = Said::kAtThisMachine},
               o.store);
  fields.value({.name = "scratch",
                .says = "Folder for fetched sessions; default the system's temporary one",
                .said = Said::kAtThisMachine},
               o.scratch);
  fields.value({.name = "memory_mb",
                .says = "That a session may hold, else it is lost alone: 1500M, 2G",
                .range = {1, 1 << 30},
                .option = "--memory",
                .units = {{"M"}, {"G", 1024}}},
               o.memory_mb);
}

Result<RunBatchReport> run_batch(const RunBatchOptions& options, const JobContext& context,
                                 const AfterSession& after) {
  Result<PlanFile> plan = open_plan(options.plan);
  if (!plan) return std::move(plan).error();
  if (Result<void> ok = check_options(options, plan->header); !ok) return std::move(ok).error();
  if (plan->header.solver_version != kSolverVersion) {
    return Error{ErrorKind::kBadData, "plan cannot be used", options.plan.string(),
                 fmt::format("it is of version {} of the solver, and this is {}", plan->header.solver_version,
                             kSolverVersion),
                 "make it again with weft batch plan"};
  }
  return BatchRun(options, std::move(*plan), context, after).run();
}

}  // namespace weft::library
