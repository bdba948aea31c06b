// SPDX-License-Identifier: Apache-2.0
// Batches of solves: what they are planned to cost and give, and what changed. Jobs plan and run them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/batch_place.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/api/routes/viewed.h"
#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "library/catalogue/session_name.h"
#include "library/run/accept_batch.h"
#include "library/run/batch_page.h"
#include "library/run/merge_batch.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostListed = 200;  // rows of each table; files have all
constexpr const char* kPage = "report.html";
constexpr const char* kReportNumbers = "report.json";
// Nothing of a report runs; its pictures are in it.
// Its script stands in it, and reaches nothing: the page is of no origin.
constexpr const char* kReportPolicy =
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data:";

fs::path batches_of(const RigParts& parts) {
  return parts.state / kBatchFolder;
}

std::string name_of_session(const std::string& folder) {
  return fs::path(folder).stem().string();
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

// One whose plan is not made, or cannot be read, stands there with what is wrong with it.
Json head_of(const fs::path& batches, const std::string& name, const Result<library::PlanFile>& plan) {
  Json head = {{"name", name},
               {"created", written_at(list_of_batch(batches, name))},
               {"is_planned", plan.has_value()},
               {"fault", ""},
               {"sessions", 0},
               {"left_out", 0},
               {"seconds", 0.0},
               {"has_report", is_there(report_of_batch(batches, name) / kPage)}};
  if (!plan) {
    if (plan.error().kind != ErrorKind::kNoInput) head["fault"] = plan.error().message();
    return head;
  }
  double seconds = 0;
  for (const library::TaskPlace& task : plan->header.tasks) seconds += task.seconds;
  head["sessions"] = plan->header.sessions;
  head["left_out"] = plan->header.left_out;
  head["seconds"] = seconds;
  return head;
}

Result<Reply> list_batches(const RigParts& parts) {
  const fs::path batches = batches_of(parts);
  Json list = Json::array();
  for (const std::string& name : batch_names(batches))
    list.push_back(head_of(batches, name, library::open_plan(plan_of_batch(batches, name))));
  return json_reply({{"batches", std::move(list)}});
}

Json levels_of(const library::BatchHeader& header) {
  Json levels = Json::array();
  for (const library::LevelTotal& level : header.levels)
    levels.push_back({{"quality", level.quality},
                      {"seconds", 3600 * level.hours},
                      {"mean_deg", level.mean_deg},
                      {"spread_deg", level.spread_deg},
                      {"solved", level.solved.value_or(1)},
                      {"sessions", level.sessions}});
  return levels;
}

Json curve_of(const library::BatchHeader& header) {
  Json curve = Json::array();
  for (const library::Spent& spent : header.curve)
    curve.push_back({{"seconds", 3600 * spent.hours}, {"mean_deg", spent.mean_deg}});
  return curve;
}

Json reasons_of(const library::BatchPlan& plan) {
  std::array<int, library::kReasonNames.size()> counts = {};
  std::array<double, library::kReasonNames.size()> seconds = {};
  for (const library::SkippedSession& left : plan.left_out) {
    ++counts.at(static_cast<std::size_t>(left.reason));
    seconds.at(static_cast<std::size_t>(left.reason)) += left.seconds;
  }
  Json reasons = Json::array();
  for (std::size_t r = 0; r < counts.size(); ++r) {
    if (counts.at(r) > 0)
      reasons.push_back(
          {{"reason", library::kReasonNames.at(r)}, {"sessions", counts.at(r)}, {"seconds", seconds.at(r)}});
  }
  return reasons;
}

// Those that cannot be solved first: somebody has to do something.
Json left_out_of(const library::BatchPlan& plan) {
  Json list = Json::array();
  for (const bool is_unsolvable : {true, false}) {
    for (const library::SkippedSession& left : plan.left_out) {
      if ((left.reason == library::SkipReason::kUnsolvable) != is_unsolvable || list.size() == kMostListed)
        continue;
      list.push_back({{"session", name_of_session(left.session)},
                      {"reason", library::kReasonNames.at(static_cast<std::size_t>(left.reason))},
                      {"said", left.said},
                      {"seconds", left.seconds}});
    }
  }
  return list;
}

// The dearest first.
Json solves_of(const library::BatchPlan& plan) {
  std::vector<const library::PlannedSolve*> solves;
  for (const library::PlannedSolve& planned : plan.solves) solves.push_back(&planned);
  std::ranges::stable_sort(solves, std::greater{},
                           [](const library::PlannedSolve* planned) { return planned->forecast.seconds; });
  if (solves.size() > kMostListed) solves.resize(kMostListed);
  Json list = Json::array();
  for (const library::PlannedSolve* planned : solves)
    list.push_back({{"session", name_of_session(planned->session)},
                    {"quality", planned->quality},
                    {"seconds", planned->forecast.seconds},
                    {"seconds_spread", planned->forecast.seconds_spread},
                    {"degrees", planned->forecast.degrees},
                    {"degrees_spread", planned->forecast.degrees_spread},
                    {"solved", planned->forecast.solved},
                    {"is_measured", planned->forecast.is_measured},
                    {"turn_deg", optional_json(planned->forecast.turn_deg)},
                    {"before", planned->before}});
  return list;
}

Json planned_of(const library::BatchState& state) {
  const library::BatchPlan& plan = state.plan;
  const library::MeanError error = library::error_of(plan.solves);
  std::uint64_t memory = 0, write = 0;
  for (const library::PlannedSolve& planned : plan.solves) {
    memory = std::max(memory, planned.memory_bytes);
    write += planned.write_bytes;
  }
  return {{"id", plan.header.id},
          {"mean_deg", error.degrees()},
          {"solved", error.solved()},
          {"memory_bytes", memory},
          {"write_bytes", write},
          {"sampled", plan.header.sampled},
          {"sample_seconds", plan.header.sample_seconds},
          {"levels", levels_of(plan.header)},
          {"curve", curve_of(plan.header)},
          {"reasons", reasons_of(plan)},
          {"left_out_sessions", left_out_of(plan)},
          {"jobs", solves_of(plan)}};
}

/// Errors of find_batch() and read_batch(); kNoInput where its plan is not made.
Result<library::BatchState> state_of(const RigParts& parts, const std::string& name) {
  const fs::path batches = batches_of(parts);
  if (const Result<fs::path> folder = find_batch(batches, name); !folder) return folder.error();
  const fs::path plan = plan_of_batch(batches, name);
  if (is_there(plan)) return library::read_batch(plan);
  return Error{ErrorKind::kNoInput, "batch is not planned", name, "its job has not made the plan",
               "wait for it, or look at why it failed"};
}

Result<Reply> one_batch(const RigParts& parts, const Call& call) {
  const std::string& name = call.segments.at(0);
  const fs::path batches = batches_of(parts);
  if (const Result<fs::path> folder = find_batch(batches, name); !folder) return folder.error();
  const fs::path file = plan_of_batch(batches, name);
  Json document = {
      {"batch", head_of(batches, name, library::open_plan(file))}, {"plan", Json()}, {"done", Json()}};
  if (!is_there(file)) return json_reply(document);
  const Result<library::BatchState> state = library::read_batch(file);
  if (!state) return state.error();
  const library::BatchSummary& s = state->summary;
  document["plan"] = planned_of(*state);
  document["done"] = {{"solved", s.solved + s.there}, {"failed", s.failed}, {"missing", s.missing}};
  return json_reply(document);
}

// By session, of the report that was written last.
std::map<std::string, std::string> pictures_of(const fs::path& report) {
  std::map<std::string, std::string> pictures;
  const Result<Json> document = read_json(report / kReportNumbers, "weft.batch-report", 1);
  if (!document || !document->contains("pictures")) return pictures;
  const auto listed = read_list<library::ListedPicture>((*document)["pictures"], kReportNumbers);
  for (const library::ListedPicture& each : listed ? *listed : std::vector<library::ListedPicture>())
    pictures[each.session] = each.file;
  return pictures;
}

// The gravest first.
Json changes_of(const library::BatchState& state, const fs::path& report) {
  const std::map<std::string, std::string> pictures = pictures_of(report);
  Json changes = Json::array();
  for (const std::size_t index : state.summary.changed) {
    if (changes.size() == kMostListed) break;
    const library::BatchRow& row = state.rows[index];
    const auto picture = pictures.find(row.planned->session);
    changes.push_back({{"session", name_of_session(row.planned->session)},
                       {"solve", row.result->solve},
                       {"before", row.planned->before},
                       {"change", object_of(*row.result->change)},
                       {"regressions", library::regressions(*row.result->change)},
                       {"picture", picture == pictures.end() ? Json() : Json(picture->second)}});
  }
  return changes;
}

Json names_of(const std::vector<std::size_t>& rows, const library::BatchState& state) {
  Json names = Json::array();
  for (const std::size_t index : rows) {
    if (names.size() == kMostListed) break;
    names.push_back(name_of_session(state.rows[index].planned->session));
  }
  return names;
}

Result<Reply> report_of(const RigParts& parts, const Call& call) {
  const std::string& name = call.segments.at(0);
  const Result<library::BatchState> state = state_of(parts, name);
  if (!state) return state.error();
  const fs::path report = report_of_batch(batches_of(parts), name);
  Json document = object_of(library::SummaryDocument{state->summary, state->rows});
  for (const char* all : {"sessions", "missing_tasks"}) document.erase(all);
  document["changed"] = state->summary.changed.size();
  document["changes"] = changes_of(*state, report);
  document["barely_solved"] = names_of(state->summary.barely_solved, *state);
  document["warned"] = names_of(state->summary.warned, *state);
  document["verdicts"] = weft::json_of(library::verdicts_of(*state));
  document["has_page"] = is_there(report / kPage);
  return json_reply(document);
}

/// The report's page, its numbers, or one of its pictures.
Result<Reply> file_of_report(const RigParts& parts, const Call& call) {
  const std::string &name = call.segments.at(0), &file = call.segments.at(1);
  const fs::path batches = batches_of(parts);
  if (const Result<fs::path> folder = find_batch(batches, name); !folder) return folder.error();
  const bool is_picture = file.starts_with("worst-") && file.ends_with(".png");
  const bool is_known =
      library::is_session_name(file) && (is_picture || file == kPage || file == kReportNumbers);
  Result<std::shared_ptr<const FileBody>> body =
      is_known ? open_file_body(report_of_batch(batches, name) / file)
               : Error{ErrorKind::kNoInput, "the report has no such file", file.substr(0, 40), "", ""};
  if (!body) return std::move(body).error();
  Reply reply = {200, is_picture      ? "image/png"
                      : file == kPage ? "text/html; charset=utf-8"
                                      : "application/json"};
  if (!is_picture) reply.headers.emplace_back("Content-Security-Policy", kReportPolicy);
  reply.file = std::move(*body);
  return reply;
}

Error unfit_acceptance(const std::string& field, const char* rule) {
  return {ErrorKind::kUsage, "solves cannot be accepted so", field, rule, "see POST batches in openapi.json"};
}

Result<library::AcceptBatchOptions> read_acceptance(const Json& body) {
  library::AcceptBatchOptions options;
  for (const auto& [key, value] : body.items()) {
    if (key == "with_worse" || key == "dry_run") {
      if (!value.is_boolean()) return unfit_acceptance(key, "must be true or false");
      (key == "dry_run" ? options.dry_run : options.with_worse) = value.get<bool>();
    } else if (key == "sessions") {
      const bool fits = value.is_array() && !value.empty() &&
                        std::ranges::all_of(value, [](const Json& each) { return each.is_string(); });
      if (!fits) return unfit_acceptance(key, "must be a list of names");
      options.sessions = value.get<std::vector<std::string>>();
    } else {
      return unfit_acceptance(key.substr(0, 40), "is no field of it");
    }
  }
  return options;
}

Result<Reply> accept_solves(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  Result<library::AcceptBatchOptions> options = read_acceptance(*body);
  if (!options) return std::move(options).error();
  const std::string& name = call.segments.at(0);
  if (const Result<library::BatchState> state = state_of(parts, name); !state) return state.error();
  options->plan = plan_of_batch(batches_of(parts), name);
  const Result<std::vector<library::Accepted>> all = library::accept_batch(*options);
  if (!all) return all.error();
  if (!options->dry_run) parts.library.expire();
  int moved = 0;
  Json left = Json::array();
  for (const library::Accepted& each : *all) {
    moved += each.is_moved ? 1 : 0;
    if (each.is_moved || left.size() == kMostListed) continue;
    left.push_back({{"session", name_of_session(each.session)}, {"why", each.why}});
  }
  return json_reply({{"dry_run", options->dry_run},
                     {"moved", moved},
                     {"left", static_cast<int>(all->size()) - moved},
                     {"left_sessions", std::move(left)}});
}

Result<Reply> forget_batch(const RigParts& parts, const Call& call) {
  const std::string& name = call.segments.at(0);
  const fs::path batches = batches_of(parts);
  if (const Result<fs::path> folder = find_batch(batches, name); !folder) return folder.error();
  for (const JobStatus& job : parts.jobs.list()) {
    const bool is_under_way = job.state == JobState::kQueued || job.state == JobState::kRunning;
    if (is_under_way && job.spec.kind.starts_with("batch_") && job.spec.of == name)
      return Error{ErrorKind::kCannotCreate, "batch cannot be forgotten", name,
                   fmt::format("its job {} is {}", job.id, name_of(job.state)), "cancel it first, or wait"};
  }
  Json head = head_of(batches, name, library::open_plan(plan_of_batch(batches, name)));
  remove_batch(batches, name);
  return json_reply(head);
}

}  // namespace

Resource batches_resource(const RigParts& parts) {
  const auto with = [&parts](Result<Reply> (*answer)(const RigParts&, const Call&)) {
    return [&parts, answer](const Call& call) { return answer(parts, call); };
  };
  return {{{"GET", "/api/v1/batches", [&parts](const Call&) { return list_batches(parts); }},
           {"GET", "/api/v1/batches/{name}", with(one_batch)},
           {"DELETE", "/api/v1/batches/{name}", with(forget_batch)},
           {"GET", "/api/v1/batches/{name}/report", with(report_of)},
           {"GET", "/api/v1/batches/{name}/files/{file}", with(file_of_report), false, Pool::kFiles},
           {"POST", "/api/v1/batches/{name}/accept", with(accept_solves)}}};
}

}  // namespace weft::app
