// SPDX-License-Identifier: Apache-2.0
#include "bench/batch/batch_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <queue>
#include <random>
#include <thread>
#include <tuple>
#include <vector>

#include "bench/batch/archive.h"
#include "bench/batch/farm_simulation.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "library/run/plan_file.h"

namespace weft::bench {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

enum class Happening { kStart, kReady, kFailure, kReturn };

struct FarmEvent {
  double time = 0;
  std::uint64_t order = 0;  // among events at one time
  Happening what = Happening::kStart;
  std::size_t which = 0;  // task or node

  bool operator>(const FarmEvent& other) const {
    return std::tie(time, order) > std::tie(other.time, other.order);
  }
};

// The end of a session by the clock that runs as fast as the store lets sessions go on.
struct SessionEnd {
  double progress = 0;
  std::size_t slot = 0;
  std::uint64_t session = 0;

  bool operator>(const SessionEnd& other) const {
    return std::tie(progress, slot) > std::tie(other.progress, other.slot);
  }
};

struct Slot {
  std::size_t task = 0;
  bool is_taken = false;
  std::uint64_t session = 0;   // which of all that were ever begun
  double began = 0, rate = 0;  // bytes a second that it asks for
};

template <typename Item>
using Earliest = std::priority_queue<Item, std::vector<Item>, std::greater<>>;

class FarmSimulation {
 public:
  explicit FarmSimulation(const FarmModel& model)
      : m_(model),
        random_(model.seed),
        slots_(static_cast<std::size_t>(model.nodes) * static_cast<std::size_t>(model.slots)),
        is_up_(static_cast<std::size_t>(model.nodes), true),
        done_(static_cast<std::size_t>(model.tasks), 0) {
    for (std::size_t task = 0; task < done_.size(); ++task) ready_.push_back(task);
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) free_.push_back(slot);
  }

  FarmOutcome run() {
    const std::int64_t all = std::int64_t{m_.tasks} * m_.sessions;
    plan_failure();
    start_tasks();
    while (outcome_.sessions < all) {
      const double session_at = next_session_at();
      const double event_at = events_.empty() ? kNever : events_.top().time;
      go_to(std::min(session_at, event_at));
      if (session_at <= event_at) {
        end_session();
      } else {
        const FarmEvent event = events_.top();
        events_.pop();
        take(event);
      }
      start_tasks();
    }
    outcome_.seconds = now_;
    outcome_.busy = outcome_.useful_s / (now_ * static_cast<double>(slots_.size()));
    return outcome_;
  }

 private:
  double speed() const {
    if (m_.store_rate <= 0 || asked_rate_ <= m_.store_rate) return 1;
    return m_.store_rate / asked_rate_;
  }

  double next_session_at() {
    while (!ends_.empty() && slots_[ends_.top().slot].session != ends_.top().session) ends_.pop();
    if (ends_.empty()) return kNever;
    return std::max(now_, now_ + (ends_.top().progress - progress_) / speed());
  }

  void go_to(double time) {
    progress_ += (time - now_) * speed();
    now_ = time;
  }

  void plan(double time, Happening what, std::size_t which) { events_.push({time, ++order_, what, which}); }

  // Nodes fail without memory, so that one clock does for all.
  void plan_failure() {
    if (m_.failure_rate <= 0) return;
    std::exponential_distribution<double> wait(m_.failure_rate * m_.nodes);
    const double time = now_ + wait(random_);
    std::uniform_int_distribution<std::size_t> node(0, is_up_.size() - 1);
    plan(time, Happening::kFailure, node(random_));
  }

  double work_of_session() {
    double work = m_.session_s;
    if (m_.spread > 0) {
      const double variance = std::log1p(m_.spread * m_.spread);
      std::lognormal_distribution<double> seconds(std::log(m_.session_s) - variance / 2, std::sqrt(variance));
      work = seconds(random_);
    }
    if (m_.node_rate > 0) work = std::max(work, m_.bytes * m_.slots / m_.node_rate);
    return work;
  }

  void begin_session(std::size_t index, double start_s) {
    Slot& slot = slots_[index];
    const double work = work_of_session() + start_s;
    slot.session = ++begun_;
    slot.began = now_;
    slot.rate = work > 0 ? m_.bytes / work : 0;
    asked_rate_ += slot.rate;
    ends_.push({progress_ + work, index, slot.session});
  }

  // What a slot does is over, one way or the other.
  double stop_session(Slot& slot) {
    asked_rate_ = std::max(0.0, asked_rate_ - slot.rate);
    slot.session = 0;
    return now_ - slot.began;
  }

  void end_session() {
    const std::size_t index = ends_.top().slot;
    ends_.pop();
    Slot& slot = slots_[index];
    outcome_.useful_s += stop_session(slot);
    ++outcome_.sessions;
    if (++done_[slot.task] < m_.sessions) {
      begin_session(index, 0);
      return;
    }
    slot.is_taken = false;
    free_.push_back(index);
  }

  void start_tasks() {
    while (!ready_.empty() && !free_.empty()) {
      if (now_ < next_start_) {
        if (!is_start_planned_) plan(next_start_, Happening::kStart, 0);
        is_start_planned_ = true;
        return;
      }
      const std::size_t index = free_.front();
      free_.pop_front();
      slots_[index].task = ready_.front();
      slots_[index].is_taken = true;
      ready_.pop_front();
      begin_session(index, m_.start_s);
      if (m_.starts_rate > 0) next_start_ = now_ + 1 / m_.starts_rate;
    }
  }

  void take(const FarmEvent& event) {
    switch (event.what) {
      case Happening::kStart:
        is_start_planned_ = false;
        return;
      case Happening::kReady:
        ready_.push_back(event.which);
        return;
      case Happening::kFailure:
        if (is_up_[event.which]) fail(event.which);
        plan_failure();
        return;
      case Happening::kReturn:
        give_back(event.which);
        return;
    }
  }

  void fail(std::size_t node) {
    ++outcome_.failures;
    is_up_[node] = false;
    const auto slots = static_cast<std::size_t>(m_.slots);
    for (std::size_t index = node * slots; index < (node + 1) * slots; ++index) {
      Slot& slot = slots_[index];
      if (!slot.is_taken) continue;
      outcome_.lost_s += stop_session(slot);
      ++outcome_.lost;
      ++outcome_.requeued;
      slot.is_taken = false;
      plan(now_ + m_.notice_s + m_.wait_s, Happening::kReady, slot.task);
    }
    std::erase_if(free_, [&](std::size_t index) { return index / slots == node; });
    plan(now_ + m_.repair_s, Happening::kReturn, node);
  }

  void give_back(std::size_t node) {
    is_up_[node] = true;
    const auto slots = static_cast<std::size_t>(m_.slots);
    for (std::size_t index = node * slots; index < (node + 1) * slots; ++index) free_.push_back(index);
  }

  const FarmModel& m_;
  std::mt19937_64 random_;
  std::vector<Slot> slots_;
  std::vector<bool> is_up_;
  std::vector<int> done_;  // sessions, by task
  std::deque<std::size_t> ready_, free_;
  Earliest<FarmEvent> events_;
  Earliest<SessionEnd> ends_;
  double now_ = 0, progress_ = 0, asked_rate_ = 0, next_start_ = 0;
  bool is_start_planned_ = false;
  std::uint64_t order_ = 0, begun_ = 0;
  FarmOutcome outcome_;
};

}  // namespace

FarmOutcome simulate_farm(const FarmModel& model) {
  return FarmSimulation(model).run();
}

namespace {

namespace fs = std::filesystem;
using FarmClock = std::chrono::steady_clock;

constexpr std::size_t kTimed = 20;  // tasks that the simulation learns its seconds from

double seconds_since(FarmClock::time_point begin) {
  return std::chrono::duration<double>(FarmClock::now() - begin).count();
}

struct TaskInHand {
  std::unique_ptr<ChildProcess> process;
  FarmClock::time_point began = FarmClock::now();
};

struct RealRun {
  double seconds = 0;
  std::vector<double> of_tasks;  // in the order in which they ended
};

Result<std::unique_ptr<ChildProcess>> begin_task(const fs::path& plan, int task, const fs::path& log) {
  return ChildProcess::start({program_beside("weft").string(), "batch", "run", plan.string(), "--task",
                              std::to_string(task), "--threads", "1", "-q"},
                             {}, log);
}

// Each task as a farm runs it: a process of one core, so many at a time.
Result<RealRun> run_tasks(const fs::path& plan, int tasks, int at_once, const fs::path& log) {
  RealRun run;
  const FarmClock::time_point begin = FarmClock::now();
  std::vector<TaskInHand> in_hand;
  for (int next = 0; next < tasks || !in_hand.empty();) {
    while (next < tasks && static_cast<int>(in_hand.size()) < at_once) {
      Result<std::unique_ptr<ChildProcess>> started = begin_task(plan, next++, log);
      if (!started) return std::move(started).error();
      in_hand.push_back({std::move(*started)});
    }
    for (std::size_t i = 0; i < in_hand.size();) {
      const std::optional<int> code = in_hand[i].process->wait(0);
      if (code && *code != 0)
        return Error{ErrorKind::kInternal, fmt::format("weft batch run ended with {}", *code), log.string(),
                     "", ""};
      if (code) {
        run.of_tasks.push_back(seconds_since(in_hand[i].began));
        in_hand.erase(in_hand.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  run.seconds = seconds_since(begin);
  return run;
}

Json row_of(const std::string& name, const FarmModel& model, const FarmOutcome& outcome) {
  const double slots = static_cast<double>(model.nodes) * model.slots;
  return {{"farm", name},
          {"tasks", model.tasks},
          {"cores", slots},
          {"sessions", outcome.sessions},
          {"hours", outcome.seconds / 3600},
          {"busy", outcome.busy},
          {"failures", outcome.failures},
          {"requeued", outcome.requeued},
          {"lost_core_hours", outcome.lost_s / 3600},
          {"real_hours", nullptr},
          {"off_by", nullptr}};
}

// The same tasks here and in the simulation, which knows the seconds of the first few alone.
Result<Json> held_against_real(const StudyOptions& options) {
  const int sessions = options.runs;
  const int at_once = resolved_threads(options.threads);
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive", plan = folder.path() / "plan.jsonl",
                 log = folder.path() / "log";
  if (Result<void> made = make_archive(archive, options.scene, options.megapixels, sessions, 4); !made)
    return std::move(made).error();
  const Result<std::string> planned = run_weft({"batch", "plan", archive.string(), "-o", plan.string(),
                                                "--sample", "1", "--task-minutes", "0.001", "-q"});
  if (!planned) return planned.error();
  const Result<library::PlanFile> file = library::open_plan(plan);
  if (!file) return file.error();
  const int tasks = static_cast<int>(file->header.tasks.size());
  const Result<RealRun> real = run_tasks(plan, tasks, at_once, log);
  if (!real) return real.error();
  const std::size_t timed = std::min(kTimed, real->of_tasks.size());
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < timed; ++i) {
    sum += real->of_tasks[i];
    squares += real->of_tasks[i] * real->of_tasks[i];
  }
  FarmModel model;
  model.slots = at_once;
  model.tasks = tasks;
  model.session_s = sum / static_cast<double>(timed);
  model.spread = std::sqrt(std::max(0.0, squares / sum / model.session_s - 1));
  const FarmOutcome outcome = simulate_farm(model);
  Json row = row_of("this machine", model, outcome);
  row["real_hours"] = real->seconds / 3600;
  row["off_by"] = outcome.seconds / real->seconds - 1;
  return row;
}

// A million sessions of 16 megapixels on 100 nodes of 8 cores, with what was measured of them and of Slurm
// (docs/archives.md).
FarmModel million() {
  FarmModel model;
  model.nodes = 100;
  model.slots = 8;
  model.tasks = 10000;
  model.sessions = 100;
  model.session_s = 5.7;
  model.spread = 0.2;
  model.start_s = 0.3;
  model.starts_rate = 4.4;
  model.notice_s = 204;
  model.wait_s = 121;
  model.repair_s = 3600;
  return model;
}

constexpr double kAll = 354e6 + 710e6, kLean = 354e6 + 106e6;

std::vector<std::pair<std::string, FarmModel>> farms() {
  std::vector<std::pair<std::string, FarmModel>> all;
  const FarmModel plain = million();
  all.emplace_back("nothing fails, a store without limit", plain);
  FarmModel each = plain;
  each.starts_rate = 1 / 2.9;
  all.emplace_back("Slurm starts a task in 2.9 s, untuned", each);
  for (const auto& [name, per_hour] :
       {std::pair{"a node fails once a year", 1 / 8766.0}, std::pair{"a node fails once a month", 1 / 730.5},
        std::pair{"a node fails once a day", 1 / 24.0}, std::pair{"a node fails once an hour", 1.0}}) {
    each = plain;
    each.failure_rate = per_hour / 3600;
    all.emplace_back(name, each);
  }
  each = plain;
  each.bytes = kAll;
  each.node_rate = 1.25e9;
  all.emplace_back("10 Gbit/s a node", each);
  each.store_rate = 10e9;
  all.emplace_back("and 10 GB/s of the store, all maps", each);
  each.failure_rate = 1 / 730.5 / 3600;
  all.emplace_back("and a node fails once a month", each);
  each.failure_rate = 0;
  each.bytes = kLean;
  each.session_s = 5.7 + 18.2;
  all.emplace_back("10 GB/s, normal and albedo in zip half", each);
  each.slots = 32;
  all.emplace_back("and 32 cores a node", each);
  return all;
}

}  // namespace

Result<Rows> batch_farm(const StudyOptions& options) {
  Result<Json> real = held_against_real(options);
  if (!real) return std::move(real).error();
  Rows rows = {std::move(*real)};
  for (const auto& [name, model] : farms()) rows.push_back(row_of(name, model, simulate_farm(model)));
  return rows;
}

}  // namespace weft::bench
