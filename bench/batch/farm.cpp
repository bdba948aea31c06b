// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "app/jobs/batch/plan_file.h"
#include "bench/batch/archive.h"
#include "bench/batch/farm_simulation.h"
#include "bench/batch/studies.h"
#include "core/parallel.h"
#include "core/process.h"
#include "core/temporary_folder.h"

namespace weft::bench {
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
  const Result<int> planned = run_program({"batch", "plan", archive.string(), "-o", plan.string(), "--sample",
                                           "1", "--task-minutes", "0.001", "-q"},
                                          log);
  if (!planned) return planned.error();
  const Result<app::PlanFile> file = app::open_plan(plan);
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
// (docs/scale.md).
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
