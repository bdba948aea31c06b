// SPDX-License-Identifier: Apache-2.0
// What comes after a batch: its report, its state, and what is done with its solves.
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
#include "core/base/process.h"
#include "core/describe/field_json.h"
#include "library/run/accept_batch.h"
#include "library/run/batch_page.h"
#include "library/run/farm_submit.h"
#include "library/run/merge_batch.h"
#include "solve/report/solve_report.h"

namespace weft::app {
namespace {

void print_state(const library::BatchSummary& s) {
  print(fmt::format("{} solved, {} there already, {} failed, {} missing, {} begun more than once", s.solved,
                    s.there, s.failed, s.missing, s.second_attempts));
  if (s.predicted_seconds > 0)
    print(fmt::format(
        "  {:.3g} node-hours, {:.3g} predicted of these, {:.2f} times what it took; {}, predicted {}; {} MB "
        "at most",
        s.seconds / 3600, s.predicted_seconds / 3600, s.seconds_ratio(),
        error_in_words(s.error.degrees(), s.error.solved()),
        error_in_words(s.predicted_error.degrees(), s.predicted_error.solved()), s.peak_bytes >> 20));
  if (const std::string grades = grades_in_words(s); !grades.empty()) print("  " + grades);
  for (const library::Cause& cause : s.causes)
    print(fmt::format("  {} {}: {}", cause.sessions, cause.sessions == 1 ? "session" : "sessions",
                      cause.example));
}

void print_changes(const library::BatchState& state) {
  constexpr std::size_t kMostShown = 10;
  const library::BatchSummary& s = state.summary;
  if (s.changed.empty()) return;
  print(fmt::format("{} compared with the solve before, {} worse in something, {} without a changed pixel",
                    s.changed.size(), s.worse, s.unchanged));
  if (s.unchanged == static_cast<int>(s.changed.size())) {
    print("  no pixel changed");
    return;
  }
  print("  mean   95 %    albedo  session");
  for (std::size_t i = 0; i < std::min(kMostShown, s.changed.size()); ++i) {
    const library::BatchRow& row = state.rows[s.changed[i]];
    const library::MapChange& change = *row.result->change;
    print(fmt::format("{:>6.3g} {:>6.3g} {:>+7.2f} %  {}  {}", change.mean_deg, change.p95_deg,
                      100 * change.albedo_bias_rel,
                      std::filesystem::path(row.planned->session).stem().string(),
                      fmt::join(library::regressions(change), "; ")));
  }
}

Result<int> merge(const std::filesystem::path& plan, const CommonArguments& common) {
  const Result<library::MergeReport> report = [&] {
    ProgressLine line(common.quiet);
    return library::merge_batch(plan, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!report) return report.error();
  const library::BatchState& state = report->state;
  if (common.json) {
    Json document = object_of(library::SummaryDocument{state.summary, state.rows});
    document["verdicts"] = weft::json_of(library::verdicts_of(state));
    document["folder"] = report->folder.string();
    document["abandoned"] = report->abandoned;
    print_json(document);
  } else {
    print_state(state.summary);
    if (report->abandoned > 0)
      print(fmt::format("  {} half-made folders of dead processes removed", report->abandoned));
    print_changes(state);
    print("look at " + (report->folder / "report.html").string());
  }
  for (const Verdict& verdict : library::verdicts_of(state))
    note(fmt::format("{}.{}", verdict.text, verdict.remedy.empty() ? "" : " To do: " + verdict.remedy + "."));
  return state.summary.is_whole() ? kDone : kDoneWithWarnings;
}

Result<int> status(const std::filesystem::path& plan, const CommonArguments& common) {
  const Result<library::BatchState> state = library::read_batch(plan);
  if (!state) return state.error();
  const library::BatchSummary& s = state->summary;
  const Result<std::optional<library::FarmQueue>> queue = library::queue_of_batch(state->file);
  if (!queue) note(queue.error().message());
  const bool has_queue = queue && *queue;
  if (common.json) {
    Json document = {{"sessions", state->plan.header.sessions},
                     {"tasks", state->plan.header.tasks.size()},
                     {"solved", s.solved},
                     {"there", s.there},
                     {"failed", s.failed},
                     {"missing", s.missing},
                     {"missing_tasks", s.missing_tasks}};
    if (has_queue) document["slurm"] = json_of_queue(**queue);
    print_json(document);
  } else {
    print_state(s);
    if (has_queue) print_queue(**queue, s.missing_tasks);
    if (!s.missing_tasks.empty()) print(fmt::format("tasks to be run: {}", fmt::join(s.missing_tasks, ",")));
  }
  return s.is_whole() ? kDone : kDoneWithWarnings;
}

Result<int> accept_solves(const library::AcceptBatchOptions& options, const CommonArguments& common) {
  const Result<std::vector<library::Accepted>> all = library::accept_batch(options);
  if (!all) return all.error();
  Json sessions = Json::array();
  int moved = 0;
  for (const library::Accepted& each : *all) {
    if (each.is_moved) ++moved;
    sessions.push_back({{"session", each.session},
                        {"solve", each.solve},
                        {"before", each.before},
                        {"moved", each.is_moved},
                        {"why", each.why}});
    if (!each.is_moved) note(fmt::format("{}: left as it is: {}", each.session, each.why));
  }
  if (common.json) {
    print_json({{"moved", options.dry_run ? 0 : moved}, {"sessions", std::move(sessions)}});
  } else {
    print(fmt::format("{} of {} sessions {}", moved, all->size(),
                      options.dry_run ? "would have their new solve as current one"
                                      : "have their new solve as current one now"));
  }
  return kDone;
}

Result<int> prune(const std::filesystem::path& plan, int keep, bool yes, const CommonArguments& common) {
  const Result<std::vector<library::Freed>> freed = library::prune_batch(plan, keep, yes);
  if (!freed) return freed.error();
  std::uint64_t bytes = 0;
  Json solves = Json::array();
  for (const library::Freed& each : *freed) {
    bytes += each.bytes;
    solves.push_back({{"session", each.session}, {"solve", each.solve}, {"bytes", each.bytes}});
    if (!common.json)
      print(fmt::format("{:>9.1f} MB  {}  {}", static_cast<double>(each.bytes) * 1e-6, each.solve,
                        each.session));
  }
  if (common.json) {
    print_json({{"pruned", yes}, {"bytes", bytes}, {"solves", std::move(solves)}});
  } else {
    print(fmt::format("{:>9.1f} MB in {} solves {}", static_cast<double>(bytes) * 1e-6, freed->size(),
                      yes ? "removed" : "would go; nothing was touched: repeat with --yes"));
  }
  return kDone;
}

void add_plan_file(Options& options, std::filesystem::path& plan) {
  options.add("plan", &plan, "Plan of weft batch plan").required();
}

Run add_merge(Options& options) {
  const auto plan = std::make_shared<std::filesystem::path>();
  add_plan_file(options, *plan);
  return [plan](const CommonArguments& common) { return merge(*plan, common); };
}

Run add_status(Options& options) {
  const auto plan = std::make_shared<std::filesystem::path>();
  add_plan_file(options, *plan);
  return [plan](const CommonArguments& common) { return status(*plan, common); };
}

Run add_commands(Options& options) {
  const auto plan = std::make_shared<std::filesystem::path>();
  const auto only_missing = std::make_shared<bool>(false);
  add_plan_file(options, *plan);
  options.add_flag("--missing", only_missing.get(), "Only tasks with a session that has no result yet");
  return [plan, only_missing](const CommonArguments& common) {
    return print_batch_commands(*plan, *only_missing, common);
  };
}

Run add_batch_accept(Options& options) {
  const auto a = std::make_shared<library::AcceptBatchOptions>();
  add_plan_file(options, a->plan);
  options.add("sessions", &a->sessions, "Names of sessions; default all of the plan");
  options.add_flag("--with-worse", &a->with_worse, "Also those that became worse in something");
  options.add_flag("--dry-run", &a->dry_run, "Only say what would change");
  return [a](const CommonArguments& common) { return accept_solves(*a, common); };
}

struct PruneBatchArguments {
  std::filesystem::path plan;
  int keep = 1;
  bool yes = false;
};

Run add_prune(Options& options) {
  const auto a = std::make_shared<PruneBatchArguments>();
  add_plan_file(options, a->plan);
  options.add("--keep", &a->keep, "Newest solves of a session to keep beside its current one")
      .in_range(0, 1000)
      .shows_default();
  options.add_flag("--yes", &a->yes, "Remove them; without it they are only listed, with their bytes");
  return [a](const CommonArguments& common) { return prune(a->plan, a->keep, a->yes, common); };
}

}  // namespace

Result<int> print_batch_commands(const std::filesystem::path& plan, bool only_missing,
                                 const CommonArguments& common) {
  std::vector<int> tasks;
  if (only_missing) {
    const Result<library::BatchState> state = library::read_batch(plan);
    if (!state) return state.error();
    tasks = state->summary.missing_tasks;
  } else {
    const Result<library::PlanFile> file = library::open_plan(plan);
    if (!file) return file.error();
    for (int task = 0; task < static_cast<int>(file->header.tasks.size()); ++task) tasks.push_back(task);
  }
  std::error_code failed;
  const std::string program = program_beside("weft").string();
  const std::string file = std::filesystem::absolute(plan, failed).lexically_normal().string();
  Json lines = Json::array();
  for (const int task : tasks) {
    const std::string line = fmt::format("{} batch run {} --task {} -q", library::shell_word(program),
                                         library::shell_word(file), task);
    lines.push_back(line);
    if (!common.json) print(line);
  }
  if (common.json) print_json({{"commands", std::move(lines)}});
  return kDone;
}

Verb batch_merge_verb() {
  return {"merge",
          "What a batch came to, and what changed from the solves before. Exit code 2 where it is not whole",
          add_merge};
}

Verb batch_status_verb() {
  return {"status", "How far a batch is, in a second. Exit code 2 where it is not whole", add_status};
}

Verb batch_commands_verb() {
  return {"commands", "A command a line for each task, for a farm of any kind", add_commands};
}

Verb batch_accept_verb() {
  return {"accept", "Make the new solves the current ones of their sessions", add_batch_accept};
}

Verb batch_prune_verb() {
  return {"prune", "Remove solves that the new ones took the place of", add_prune};
}

}  // namespace weft::app
