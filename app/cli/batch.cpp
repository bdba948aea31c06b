// SPDX-License-Identifier: Apache-2.0
// Plans of many solves, and running them; batch_reports.cpp has what comes afterwards.
#include "app/cli/batch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/library_place.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "core/describe/field_check.h"
#include "core/solve/solve.h"
#include "library/batch/session_list.h"
#include "library/run/farm_submit.h"
#include "library/run/lean.h"
#include "library/run/merge_batch.h"
#include "library/run/plan_batch.h"
#include "library/run/run_batch.h"
#include "library/run/survey.h"
#include "solve/report/solve_report.h"

namespace weft::app {
namespace {

struct PlanArguments {
  library::PlanBatchOptions options;
  std::string find;
  std::filesystem::path list;
  LibraryPlace place;
  library::Query query;
};

std::string on_standard_input() {
  return {std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
}

// Sessions of the library by what people say of them.
Result<void> add_found(const PlanArguments& a, const CommonArguments& common,
                       std::vector<std::string>& sessions) {
  Result<library::Catalogue> catalogue = fresh_catalogue(a.place, common);
  if (!catalogue) return std::move(catalogue).error();
  library::Query query = a.query;
  query.words = a.find;
  query.limit = 1000;
  do {
    const Result<library::CataloguePage> page = catalogue->find(query);
    if (!page) return page.error();
    for (const library::Entry& entry : page->entries) sessions.push_back(entry.folder.string());
    query.after = page->after;
  } while (query.after);
  std::ranges::sort(sessions);
  return {};
}

Result<void> add_sessions(const PlanArguments& a, const CommonArguments& common,
                          library::PlanBatchOptions& options) {
  options.sessions.clear();
  for (const std::string& each : a.options.sessions) {
    if (each != "-") {
      options.sessions.push_back(each);
      continue;
    }
    for (std::string& read : library::sessions_of_text(on_standard_input()))
      options.sessions.push_back(std::move(read));
    if (options.sessions.empty())
      return Error{ErrorKind::kNoInput, "there is nothing to plan", "standard input", "it names no session",
                   "write the folder of a session on each line"};
  }
  if (!a.list.empty()) {
    const Result<std::string> text = read_text(a.list);
    if (!text) return text.error();
    for (std::string& read : library::sessions_of_text(*text)) options.sessions.push_back(std::move(read));
    if (options.sessions.empty())
      return Error{ErrorKind::kNoInput, "there is nothing to plan", a.list.string(), "it names no session",
                   "write the folder of a session on each line"};
  }
  const bool searches = !a.find.empty() || !a.query.tag.empty() || !a.query.rig.empty() ||
                        !a.query.calibration.empty() || !a.query.from.empty() || !a.query.before.empty();
  if (!searches) return {};
  return add_found(a, common, options.sessions);
}

std::string hours_words(double hours) {
  if (hours < 1.0 / 60) return fmt::format("{:.2g} seconds", 3600 * hours);
  return hours < 1 ? fmt::format("{:.2g} minutes", 60 * hours) : fmt::format("{:.3g} hours", hours);
}

void print_left_out(const library::BatchPlan& plan) {
  const std::array words = {"have their solve already", "cannot be solved", "would turn by less than asked",
                            "reach no such error at any level"};
  for (std::size_t r = 0; r < library::kReasonNames.size(); ++r) {
    int count = 0;
    double seconds = 0;
    for (const library::SkippedSession& left : plan.left_out) {
      if (static_cast<std::size_t>(left.reason) != r) continue;
      ++count;
      seconds += left.seconds;
    }
    if (count == 0) continue;
    const bool saves = seconds > 0 && r != static_cast<std::size_t>(library::SkipReason::kUnsolvable);
    print(fmt::format("{} left out: they {}{}", count, words[r],
                      saves ? ", " + hours_words(seconds / 3600) + " saved" : ""));
  }
  for (const library::SkippedSession& left : plan.left_out) {
    if (left.reason == library::SkipReason::kUnsolvable) note(left.said);
  }
}

struct PlanSums {
  double hours = 0, read_gb = 0, write_gb = 0;
  library::MeanError error;
  std::uint64_t memory_bytes = 0;
};

PlanSums sums_of(const library::BatchPlan& plan) {
  PlanSums sums;
  sums.error = library::error_of(plan.solves);
  for (const library::PlannedSolve& planned : plan.solves) {
    sums.hours += planned.forecast.seconds / 3600;
    sums.read_gb += static_cast<double>(planned.read_bytes) * 1e-9;
    sums.write_gb += static_cast<double>(planned.write_bytes) * 1e-9;
    sums.memory_bytes = std::max(sums.memory_bytes, planned.memory_bytes);
  }
  return sums;
}

void print_plan(const library::PlanBatchReport& report) {
  const library::BatchPlan& plan = report.plan;
  const library::BatchHeader& header = plan.header;
  print("level       node-hours of all   degrees        of  spread  planned");
  for (const library::LevelTotal& level : header.levels) {
    const std::string error = header.sampled > 0
                                  ? fmt::format("{:>9.3g} {:>9} {:>7.2g}", level.mean_deg,
                                                share_in_words(level.solved.value_or(1)), level.spread_deg)
                                  : fmt::format("{:>9} {:>9} {:>7}", "-", "-", "-");
    print(fmt::format("{:<10} {:>18.3g} {} {:>8}", level.quality, level.hours, error, level.sessions));
  }
  if (!header.curve.empty())
    print(
        "hours spent where they buy most, and the mean error in degrees, a radian where there is no normal:");
  for (const library::Spent& spent : header.curve)
    print(fmt::format("  {:>9.3g} {:>9.3g}", spent.hours, spent.mean_deg));
  const PlanSums sums = sums_of(plan);
  print(fmt::format(
      "sessions {}, tasks {}: {}, {}, {:.3g} GB read, {:.3g} GB written, {} MB of memory", header.sessions,
      header.tasks.size(), hours_words(sums.hours),
      header.sampled > 0 ? error_in_words(sums.error.degrees(), sums.error.solved()) : "no error foretold",
      sums.read_gb, sums.write_gb, sums.memory_bytes >> 20));
  print(
      fmt::format("  measured on {} of them in {:.3g} s, with {} threads; the rest of planning took {:.3g} s",
                  header.sampled, header.sample_seconds, header.threads, report.seconds));
  if (!header.product.then.empty())
    print(fmt::format("  {} of each {} these hours", fmt::join(header.product.then, ", "),
                      header.sampled > 0 ? "are among" : "come on top of"));
  for (const library::PlannedSolve& planned : plan.solves) {
    if (planned.forecast.solved < kLeastSolved)
      note(fmt::format("{}: only {} of its cloth will have a normal: scan it again",
                       std::filesystem::path(planned.session).stem().string(),
                       share_in_words(planned.forecast.solved)));
  }
  print_left_out(plan);
  print(report.file.string());
}

Json plan_json(const library::PlanBatchReport& report) {
  const library::BatchHeader& header = report.plan.header;
  const PlanSums sums = sums_of(report.plan);
  Json levels = Json::array(), curve = Json::array(), left_out = Json::array();
  const auto if_sampled = [&](double number) { return header.sampled > 0 ? Json(number) : Json(); };
  for (const library::LevelTotal& level : header.levels)
    levels.push_back({{"quality", level.quality},
                      {"hours", level.hours},
                      {"mean_deg", if_sampled(level.mean_deg)},
                      {"spread_deg", if_sampled(level.spread_deg)},
                      {"solved", if_sampled(level.solved.value_or(1))},
                      {"sessions", level.sessions}});
  for (const library::Spent& spent : header.curve)
    curve.push_back({{"hours", spent.hours}, {"mean_deg", spent.mean_deg}});
  for (const library::SkippedSession& left : report.plan.left_out)
    left_out.push_back({{"session", left.session},
                        {"left_out", library::kReasonNames[static_cast<std::size_t>(left.reason)]},
                        {"said", left.said},
                        {"seconds", left.seconds}});
  return {{"plan", report.file.string()},
          {"id", header.id},
          {"sessions", header.sessions},
          {"tasks", header.tasks.size()},
          {"hours", sums.hours},
          {"mean_deg", if_sampled(sums.error.degrees())},
          {"solved", if_sampled(sums.error.solved())},
          {"read_gb", sums.read_gb},
          {"write_gb", sums.write_gb},
          {"memory_bytes", sums.memory_bytes},
          {"sampled", header.sampled},
          {"sample_seconds", header.sample_seconds},
          {"seconds", report.seconds},
          {"levels", std::move(levels)},
          {"curve", std::move(curve)},
          {"left_out", std::move(left_out)}};
}

Result<int> plan(const PlanArguments& a, const CommonArguments& common) {
  library::PlanBatchOptions options = a.options;
  if (Result<void> fits = check_fields(options); !fits) return std::move(fits).error();
  if (Result<void> ok = add_sessions(a, common, options); !ok) return std::move(ok).error();
  const Result<library::PlanBatchReport> report = [&] {
    ProgressLine line(common.quiet);
    return library::plan_batch(options, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!report) return report.error();
  if (common.json) {
    print_json(plan_json(*report));
  } else {
    print_plan(*report);
  }
  return kDone;
}

std::string words_of(const library::TaskOutcome& outcome) {
  const std::string name = std::filesystem::path(outcome.session).stem().string();
  switch (outcome.state) {
    case library::TaskState::kSolved:
    case library::TaskState::kThere:
      return fmt::format(
          "{}: {}{}{}{}", name,
          outcome.state == library::TaskState::kThere ? "is there already"
                                                      : fmt::format("solved in {:.2f} s", outcome.seconds),
          outcome.verdict ? ", " + words_of(*outcome.verdict) : "",
          outcome.change ? fmt::format(", turned by {:.3g} degrees", outcome.change->mean_deg) : "",
          outcome.change && library::regression_weight(*outcome.change) > 0
              ? fmt::format(", worse: {}", fmt::join(library::regressions(*outcome.change), "; "))
              : "");
    case library::TaskState::kFailed:
      return fmt::format("{}: failed: {}", name, outcome.error->message());
    case library::TaskState::kLost:
      break;
  }
  return fmt::format("{}: no result: {}", name, outcome.error->message());
}

// One code for several errors of one kind, else `otherwise`.
int code_of_all(const std::vector<ErrorKind>& kinds, int otherwise) {
  const bool is_one = std::ranges::all_of(kinds, [&](ErrorKind kind) { return kind == kinds.front(); });
  return is_one && !kinds.empty() ? exit_code_of(kinds.front()) : otherwise;
}

int code_of(const library::RunBatchReport& report) {
  if (report.was_stopped) return is_stopped_by_hand() ? kInterruptedError : kTryAgainError;
  if (!report.losses.empty()) return code_of_all(report.losses, kTryAgainError);
  if (!report.failures.empty()) return code_of_all(report.failures, kBadDataError);
  return kDone;
}

void print_run(const library::RunBatchReport& report, const std::optional<library::MergeReport>& merged,
               const CommonArguments& common) {
  if (common.json) {
    Json document = {{"kept", report.kept},           {"kept_failures", report.kept_failures},
                     {"solved", report.solved},       {"there", report.there},
                     {"failed", report.failed},       {"lost", report.lost},
                     {"not_begun", report.not_begun}, {"stopped", report.was_stopped},
                     {"seconds", report.seconds}};
    if (merged) {
      const library::BatchSummary& s = merged->state.summary;
      document["report"] = {{"folder", merged->folder.string()},
                            {"failed", s.failed},
                            {"missing", s.missing},
                            {"changed", s.changed.size()},
                            {"worse", s.worse}};
    }
    return print_json(document);
  }
  print(fmt::format(
      "{} solved, {} there already, {} done before, {} failed, {} failed before, {} to be run again; "
      "{:.1f} s",
      report.solved, report.there, report.kept, report.failed, report.kept_failures,
      report.lost + report.not_begun, report.seconds));
  if (merged) print("look at " + (merged->folder / "report.html").string());
}

Result<int> run(const library::RunBatchRequest& request, const CommonArguments& common) {
  library::RunBatchOptions options = request.options;
  if (request.array_from) {
    const Result<int> task = library::task_of_array(*request.array_from);
    if (!task) return task.error();
    options.task = *task;
  }
  const auto after = [&](const library::TaskOutcome& outcome, double hours_left) {
    const bool is_bad = !outcome.is_done();
    if (common.quiet && !is_bad) return;
    note(fmt::format("{}; {} left", words_of(outcome), hours_words(hours_left)));
  };
  // Each session is a line of its own for people; programs hear of shares too.
  ProgressLine line(true);
  const JobContext context = {common.threads, stop_on_signal(), line.callback()};
  const Result<library::RunBatchReport> report = library::run_batch(options, context, after);
  if (!report) return report.error();
  std::optional<library::MergeReport> merged;
  if (request.merges && !report->was_stopped) {
    Result<library::MergeReport> made = library::merge_batch(options.plan, context);
    if (!made) return std::move(made).error();
    merged = std::move(*made);
  }
  print_run(*report, merged, common);
  if (merged) return merged->state.summary.is_whole() ? kDone : kDoneWithWarnings;
  return request.array_from ? after_own_task(code_of(*report)) : code_of(*report);
}

void add_choice_of_sessions(Options& options, PlanArguments& a) {
  options.add("sessions", &a.options.sessions,
              "Folders of sessions, or with sessions below them; - reads them from standard input, as weft "
              "calibrate history --affected and weft library find print them");
  options.add("--list", &a.list, "File that names sessions, as - reads it");
  options.add("--find", &a.find, "Also sessions of the library: words, each as the beginning of a word");
  options.add("--tag", &a.query.tag, "Tag that those of the library have");
  options.add("--rig", &a.query.rig, "Name of their rig");
  options.add("--calibrated-by", &a.query.calibration, "Id of their calibration");
  options.add("--from", &a.query.from, "Taken at or after this ISO time, or its beginning: 2026-11");
  options.add("--before", &a.query.before, "Taken before it");
  add_place(options, a.place);
}

Run add_plan(Options& options) {
  const auto a = std::make_shared<PlanArguments>();
  add_choice_of_sessions(options, *a);
  add_options(options, a->options);
  return [a](const CommonArguments& common) { return plan(*a, common); };
}

Run add_run(Options& options) {
  const auto a = std::make_shared<library::RunBatchRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return run(*a, common); };
}

}  // namespace

Verb batch_plan_verb() {
  return {"plan", "Price many sessions by a sample of them, and write down what is to be solved", add_plan};
}

Verb batch_run_verb() {
  return {
      "run",
      "Solve a plan, or one task of it, as far as it is not done. Exit code 75 where it is to be run again",
      add_run};
}

Verb batch_verb() {
  return {.name = "batch",
          .help = "Solve archives: plan, run, and see what changed",
          .verbs = {batch_plan_verb(), batch_run_verb(), batch_merge_verb(), batch_status_verb(),
                    batch_commands_verb(), batch_submit_verb(), batch_cancel_verb(), batch_accept_verb(),
                    batch_prune_verb()}};
}

}  // namespace weft::app
