// SPDX-License-Identifier: Apache-2.0
// Batches on farms.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/batch.h"
#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "library/run/farm_submit.h"

namespace weft::app {
namespace {

struct SubmitArguments {
  library::SubmitOptions options;
  std::string backend = "slurm";
};

// The command as a shell takes it.
std::string shell_line(const std::vector<std::string>& command) {
  std::string line;
  for (const std::string& word : command) line += (line.empty() ? "" : " ") + library::shell_word(word);
  return line;
}

Json submitted_json(const library::SubmitReport& report) {
  Json arrays = Json::array();
  for (const library::SbatchCall& each : report.arrays)
    arrays.push_back({{"job", each.job},
                      {"tasks", each.array.tasks},
                      {"memory_bytes", each.array.memory_bytes},
                      {"minutes", each.array.minutes},
                      {"command", each.command}});
  Json document = {{"missing", report.missing},
                   {"queued_before", report.queued.tasks.size()},
                   {"jobs_before", report.queued.jobs()},
                   {"arrays", std::move(arrays)}};
  if (report.merge) document["merge"] = {{"job", report.merge->job}, {"command", report.merge->command}};
  return document;
}

void print_submitted(const library::SubmitReport& report, bool dry_run) {
  if (!report.queued.tasks.empty())
    print(fmt::format("{} tasks are queued already: job {}", report.queued.tasks.size(),
                      fmt::join(report.queued.jobs(), ", ")));
  for (const library::SbatchCall& each : report.arrays) {
    print(dry_run ? shell_line(each.command)
                  : fmt::format("job {}: {} tasks, {} MB and {} minutes each", each.job,
                                each.array.tasks.size(), each.array.memory_bytes >> 20, each.array.minutes));
  }
  if (report.merge)
    print(dry_run ? shell_line(report.merge->command)
                  : fmt::format("job {}: the report, after them", report.merge->job));
  if (report.missing == 0) print("every session has a result: there is nothing to submit");
}

Result<int> submit_plan(const SubmitArguments& a, const CommonArguments& common) {
  if (a.backend == "commands") return print_batch_commands(a.options.plan, true, common);
  const Result<library::SubmitReport> report = library::submit_batch(a.options);
  if (!report) return report.error();
  if (common.json) {
    print_json(submitted_json(*report));
  } else {
    print_submitted(*report, a.options.dry_run);
  }
  return kDone;
}

Result<int> cancel_plan(const std::filesystem::path& plan, const CommonArguments& common) {
  const Result<library::FarmQueue> queue = library::cancel_batch(plan);
  if (!queue) return queue.error();
  if (common.json) {
    print_json({{"cancelled", queue->tasks.size()}, {"jobs", queue->jobs()}});
  } else if (queue->tasks.empty() && queue->merges.empty()) {
    print("nothing of it is queued");
  } else {
    print(fmt::format("{} tasks cancelled; what is solved stays", queue->tasks.size()));
  }
  return kDone;
}

Run add_submit(Options& options) {
  const auto a = std::make_shared<SubmitArguments>();
  library::FarmOptions& farm = a->options.farm;
  options.add("plan", &a->options.plan, "Plan of weft batch plan").required();
  options.add("--backend", &a->backend, "slurm, or commands: one command a line for any other farm")
      .one_of({"slurm", "commands"})
      .shows_default();
  options.add("--partition", &farm.partition, "Of Slurm; default its own");
  options.add("--account", &farm.account, "That pays for it");
  options.add("--qos", &farm.qos, "Quality of service, as the cluster names it");
  options.add("--at-once", &farm.at_once, "Tasks that run at a time at most; 0: as many as Slurm gives")
      .in_range(0, 1000000)
      .shows_default();
  options.add("--cores", &farm.cores, "Of a task").in_range(1, 1024).shows_default();
  options.add("--sbatch", &farm.more, "Further argument of sbatch: --sbatch=--nice=100; may be given again")
      .one_at_a_time();
  options.add_flag("--dry-run", &a->options.dry_run, "Only print what would be submitted");
  return [a](const CommonArguments& common) { return submit_plan(*a, common); };
}

Run add_cancel(Options& options) {
  const auto plan = std::make_shared<std::filesystem::path>();
  options.add("plan", plan.get(), "Plan of weft batch plan").required();
  return [plan](const CommonArguments& common) { return cancel_plan(*plan, common); };
}

}  // namespace

Json json_of_queue(const library::FarmQueue& queue) {
  return {{"running", queue.count("RUNNING")},
          {"queued", queue.tasks.size()},
          {"jobs", queue.jobs()},
          {"merge", queue.merges}};
}

void print_queue(const library::FarmQueue& queue, const std::vector<int>& missing_tasks) {
  if (queue.tasks.empty() && queue.merges.empty()) return;
  const auto delayed = std::ranges::count(queue.tasks, "BeginTime", &library::QueuedTask::reason);
  print(fmt::format(
      "Slurm: {} tasks run, {} wait{}: job {}", queue.count("RUNNING"),
      static_cast<int>(queue.tasks.size()) - queue.count("RUNNING"),
      delayed > 0 ? fmt::format(", {} of them for their time after they were queued again", delayed) : "",
      fmt::join(queue.jobs(), ", ")));
  const std::size_t lost = library::not_queued(missing_tasks, queue).size();
  if (lost > 0) print(fmt::format("  {} tasks have work left and are not queued: weft batch submit", lost));
}

int after_own_task(int code) {
  if (code != kTryAgainError) return code;
  const Result<bool> queued = library::requeue_own_task();
  if (!queued) complain(queued.error());
  note(queued && *queued ? "queued again by Slurm" : "not queued again");
  return code;
}

Verb batch_submit_verb() {
  return {"submit",
          "Give the tasks of a plan to Slurm, or print them for another farm. Done again it sends what is "
          "missing",
          add_submit};
}

Verb batch_cancel_verb() {
  return {"cancel", "End what Slurm has of a plan. What is solved stays", add_cancel};
}

}  // namespace weft::app
