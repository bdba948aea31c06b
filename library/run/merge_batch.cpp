// SPDX-License-Identifier: Apache-2.0
#include "library/run/merge_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "core/solve/solve.h"
#include "core/solve/solve_record.h"
#include "library/run/abandoned.h"
#include "library/run/batch_page.h"
#include "library/run/change_pictures.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReportSchema = "weft.batch-report/1.1";

std::string picture_name(std::size_t number) {
  return fmt::format("worst-{:02}.png", number);
}

fs::path solves_of(const BatchPlan& plan, const PlannedSolve& planned) {
  return solve_parent(plan.header, planned.session);
}

// A solve that nobody wrote down: its process was killed in between.
std::optional<TaskOutcome> unwritten(const BatchPlan& plan, const PlannedSolve& planned) {
  const fs::path folder = solves_of(plan, planned) / planned.solve;
  const fs::path document = folder / kSolveProduct.document;
  if (!is_there(document)) return {};
  const Result<Json> json = read_json(document, kSolveProduct.schema, 1);
  if (!json) return {};
  const Result<SolveFacts> facts = solve_facts_from_json(*json, document.string());
  if (!facts) return {};
  TaskOutcome outcome;
  outcome.plan = plan.header.id;
  outcome.session = planned.session;
  outcome.state = TaskState::kThere;
  outcome.solve = planned.solve;
  outcome.folder = folder.string();
  outcome.no_change = "its process was killed before it compared them: run the same command again";
  if (facts->taken) outcome.solved = facts->taken->solved;
  if (facts->check) outcome.left_out = facts->check->all.rms;
  for (const Verdict& warning : facts->warnings) {
    outcome.warnings.push_back(warning.name);
    if (is_of_frames(warning)) outcome.frames.push_back(warning.text);
  }
  return outcome;
}

void hold_against_folders(const BatchPlan& plan, BatchRow& row) {
  if (row.is_done() && !row.result->is_stored &&
      !is_there(fs::path(row.result->folder) / kSolveProduct.document)) {
    row.lost = TaskOutcome{};
    row.lost->error = {ErrorKind::kTryAgain, "its solve is gone", row.result->folder, "somebody removed it",
                       "run the same command again"};
    row.result.reset();
  }
  if (row.is_missing()) row.result = unwritten(plan, *row.planned);
}

Result<void> write_pictures(const BatchState& state, const fs::path& folder, std::vector<DrawnChange>& drawn,
                            const JobContext& context) {
  for (std::size_t i = 1; i <= kMostDrawn; ++i) {
    std::error_code ignored;
    fs::remove(folder / picture_name(i), ignored);  // of an earlier report
  }
  for (const std::size_t index : state.summary.changed) {
    if (drawn.size() == kMostDrawn || context.stop.stop_requested()) break;
    const BatchRow& row = state.rows[index];
    if (row.result->change->is_none() || row.result->is_stored) continue;
    const fs::path before = fs::path(row.planned->session) / "solve" / row.planned->before;
    Result<std::string> png = draw_change(before, row.result->folder, *row.planned, *row.result->change);
    // A solve that went since then leaves no picture, and its numbers stay.
    if (!png) continue;
    const std::string name = picture_name(drawn.size() + 1);
    if (Result<void> written = write_file(folder / name, *png); !written) return written;
    drawn.push_back({row.planned->session, name, std::move(*png)});
    context.progress("draw", static_cast<double>(drawn.size()) / kMostDrawn);
  }
  return {};
}

}  // namespace

void describe(Fields& fields, ListedPicture& p) {
  fields.value({"session", "Its folder", {}, kMustSay}, p.session);
  fields.value({"file", "Beside the report", {}, kMustSay}, p.file);
}

void describe(Fields& fields, ListedLeftOut& l) {
  SkippedSession& of = l.left_out;
  fields.value({"session", "Its folder", {}, kMustSay}, of.session);
  fields.choice({"left_out", "Why it is not solved", {}, kMustSay}, of.reason, kReasonNames);
  fields.value({"said", "One sentence"}, of.said);
  fields.value({"seconds", "That are saved"}, of.seconds);
}

void describe(Fields& fields, BatchReportFacts& f) {
  fields.value({"plan", "Its id", {}, kMustSay}, f.plan);
  describe(fields, f.summary);
  fields.list({"left_out", "Sessions that are not solved"}, f.left_out);
  fields.list({"pictures", "Of those that changed most gravely, before and after"}, f.pictures);
  fields.value({"abandoned", "Half-made folders that were removed"}, f.abandoned);
}

Result<BatchState> read_batch(const fs::path& plan_file) {
  Result<PlanFile> file = open_plan(plan_file);
  if (!file) return std::move(file).error();
  Result<BatchPlan> plan = read_plan(plan_file);
  if (!plan) return std::move(plan).error();
  const Result<std::map<std::string, TaskHistory>> histories = read_histories(*file, {});
  if (!histories) return histories.error();
  BatchState state;
  state.file = std::move(*file);
  state.plan = std::move(*plan);
  state.rows = rows_of(state.plan, *histories);
  for (BatchRow& row : state.rows) hold_against_folders(state.plan, row);
  state.summary = summarize(state.rows);
  return state;
}

Result<MergeReport> merge_batch(const fs::path& plan, const JobContext& context) {
  Result<BatchState> state = read_batch(plan);
  if (!state) return std::move(state).error();
  MergeReport report;
  for (const BatchRow& row : state->rows)
    report.abandoned +=
        remove_folders(abandoned_of(row.planned->session, solves_of(state->plan, *row.planned)));
  report.folder = state->file.results() / "report";
  if (Result<void> made = make_writable_folder(report.folder); !made) return std::move(made).error();
  std::vector<DrawnChange> drawn;
  if (Result<void> ok = write_pictures(*state, report.folder, drawn, context); !ok)
    return std::move(ok).error();
  BatchReportFacts facts = {state->plan.header.id, {state->summary, state->rows}, {}, {}, report.abandoned};
  for (const SkippedSession& left : state->plan.left_out) facts.left_out.push_back({left});
  for (const DrawnChange& each : drawn) facts.pictures.push_back({each.session, each.file});
  Json document = {{"schema", kReportSchema}};
  write_fields(document, std::move(facts));
  if (Result<void> ok = write_json(report.folder / "report.json", document); !ok)
    return std::move(ok).error();
  const std::string page = batch_page(*state, drawn);
  if (Result<void> ok = write_file(report.folder / "report.html", page); !ok) return std::move(ok).error();
  report.state = std::move(*state);
  return report;
}

}  // namespace weft::library
