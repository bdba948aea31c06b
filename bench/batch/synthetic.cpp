// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "app/jobs/batch/plan_file.h"
#include "batch/outcome.h"
#include "batch/plan.h"
#include "bench/batch/archive.h"
#include "bench/batch/studies.h"
#include "core/files.h"
#include "core/job.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kOwn = 10, kSample = 10;

batch::Outcome outcome_of(const batch::Plan& plan, const batch::Job& job, int number) {
  batch::Outcome outcome;
  outcome.plan = plan.header.id;
  outcome.session = job.session;
  outcome.state = batch::State::kSolved;
  outcome.solve = job.solve;
  outcome.folder = batch::solve_parent(plan.header, job.session) + "/" + job.solve;
  outcome.seconds = outcome.node_seconds = 5;
  outcome.sigma_deg = 0.6;
  outcome.left_out = 0.03 + 1e-6 * number;
  batch::Change change;
  change.pixels = 16'000'000;
  change.mean_deg = 0.1 + 1e-5 * number;
  change.p95_deg = 2 * change.mean_deg;
  change.max_deg = 9;
  change.sigma_deg = {0.6, 0.6};
  outcome.change = change;
  return outcome;
}

}  // namespace

Result<Rows> batch_plan(const StudyOptions& options) {
  const int sessions = options.runs;
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive", log = folder.path() / "log";
  if (Result<void> made = make_archive(archive, options.scene, options.megapixels, sessions, kOwn); !made)
    return made.error();
  Stopwatch watch;
  const Result<int> code = run_program(
      {"batch", "plan", archive.string(), "-o", (folder.path() / "plan.jsonl").string(), "--sample",
       std::to_string(kSample), "--json", "-q", "--threads", std::to_string(options.threads)},
      log);
  const double wall_s = watch.lap();
  if (!code) return code.error();
  const Result<std::string> said = read_text(log);
  const Json planned = said ? Json::parse(*said, nullptr, false) : Json();
  if (*code != 0 || !planned.is_object())
    return Error{ErrorKind::kInternal, fmt::format("weft batch plan ended with {}", *code), log.string(),
                 said ? said->substr(0, 2000) : "", ""};
  const double sample_s = planned["sample_seconds"].get<double>();
  return Rows{{{"sessions", planned["sessions"]},
               {"tasks", planned["tasks"]},
               {"plan_s", wall_s - sample_s},
               {"asked_s", 60},
               {"sample", planned["sampled"]},
               {"sample_s", sample_s}}};
}

Result<Rows> batch_merge(const StudyOptions& options) {
  const int sessions = options.runs;
  const TemporaryFolder folder;
  const fs::path archive = folder.path() / "archive", file = folder.path() / "plan.jsonl",
                 log = folder.path() / "log";
  batch::Plan plan;
  plan.header.archive = archive.string();
  for (int i = 0; i < sessions; ++i) {
    batch::Job job;
    job.session = session_in(archive, i).string();
    job.digest = std::string(64, 'a');
    job.quality = "standard";
    job.solve = fmt::format("{:016x}", i);
    job.before = "before";
    job.rig = fmt::format("rig {}", i % 3);
    job.calibration = fmt::format("calibration {}", i % 3);
    job.megapixels = 16;
    job.forecast.seconds = 6;
    plan.jobs.push_back(std::move(job));
  }
  batch::share_out(plan.jobs, 600);
  if (const Result<void> written = app::write_plan(file, batch::text_of(plan)); !written)
    return written.error();
  const Result<app::PlanFile> opened = app::open_plan(file);
  if (!opened) return opened.error();
  fs::create_directories(opened->results());
  for (int i = 0; i < sessions; ++i) {
    const batch::Job& job = plan.jobs[static_cast<std::size_t>(i)];
    const batch::Outcome outcome = outcome_of(plan, job, i);
    fs::create_directories(outcome.folder);
    std::ofstream(fs::path(outcome.folder) / "solve.json") << "{}";
    std::ofstream(opened->results_of(job.task), std::ios::app) << batch::line_of(outcome);
  }
  Stopwatch watch;
  const Result<int> code = run_program({"batch", "merge", file.string(), "-q"}, log);
  const double merge_s = watch.lap();
  if (!code) return code.error();
  if (*code != 0) {
    const Result<std::string> said = read_text(log);
    return Error{ErrorKind::kInternal, fmt::format("weft batch merge ended with {}", *code), log.string(),
                 said ? said->substr(0, 2000) : "", ""};
  }
  return Rows{
      {{"results", sessions}, {"tasks", plan.header.tasks.size()}, {"merge_s", merge_s}, {"asked_s", 30}}};
}

}  // namespace weft::bench
