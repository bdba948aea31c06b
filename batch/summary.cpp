// SPDX-License-Identifier: Apache-2.0
#include "batch/summary.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/error_json.h"
#include "core/error_kind.h"
#include "core/solve.h"
#include "core/statistics.h"

namespace weft::batch {
namespace {

// What a wrong calibration makes a solve say (app/jobs/report.h).
constexpr std::array<std::string_view, 4> kOfCalibration = {"LIGHTS_DO_NOT_FIT", "LEDS_EXCHANGED", "LED_DEAD",
                                                            "LED_GAIN"};

bool speaks_against_lights(const Outcome& outcome) {
  return std::ranges::any_of(outcome.warnings, [](const std::string& warning) {
    return std::ranges::find(kOfCalibration, std::string_view(warning)) != kOfCalibration.end();
  });
}

void count(const Row& row, Summary& summary) {
  if (row.attempts > 1) ++summary.second_attempts;
  if (row.has_failed()) ++summary.failed;
  if (row.is_missing()) ++summary.missing;
  if (!row.is_done()) return;
  const Outcome& outcome = *row.result;
  if (outcome.state == State::kThere) {
    ++summary.there;
    return;
  }
  ++summary.solved;
  summary.error.add(outcome.expected_deg, outcome.solved_share());
  summary.predicted_error.add(row.job->forecast.degrees, row.job->forecast.solved);
  summary.seconds += outcome.node_seconds;
  summary.predicted_seconds += row.job->forecast.seconds;
  summary.peak_bytes = std::max(summary.peak_bytes, outcome.peak_bytes);
}

std::vector<Cause> causes_of(std::span<const Row> rows) {
  std::map<std::pair<std::string, std::string>, Cause> by_name;
  for (const Row& row : rows) {
    if (row.is_done()) continue;
    const std::optional<Error> error = row.result ? row.result->error
                                       : row.lost ? row.lost->error
                                                  : std::nullopt;
    const std::string kind = error ? name_of(error->kind) : "not_begun";
    const std::string what = error ? error->what : "not begun, or its process was killed";
    Cause& cause = by_name[{kind, what}];
    cause.kind = kind;
    cause.what = what;
    ++cause.sessions;
    if (cause.example.empty()) cause.example = error ? error->message() : what + ": " + row.job->session;
  }
  std::vector<Cause> causes;
  for (auto& [name, cause] : by_name) causes.push_back(std::move(cause));
  std::ranges::stable_sort(causes, [](const Cause& a, const Cause& b) { return a.sessions > b.sessions; });
  return causes;
}

// How much speaks against a calibration: sessions that became worse or whose lights do not fit, then left-out
// lights that are predicted much worse than with the others, then how far maps turned.
std::tuple<double, double, double> suspicion(const ByCalibration& c) {
  const double sessions = std::max(c.sessions, 1);
  return {std::max(c.worse, c.warned) / sessions, c.usual_left_out ? *c.left_out : 0,
          c.mean_turn_deg.value_or(0)};
}

std::vector<ByCalibration> by_calibration(std::span<const Row> rows) {
  struct Gathered {
    ByCalibration all;
    std::vector<double> left_out;
    double turned = 0;
    int compared = 0;
  };
  std::map<std::string, Gathered> gathered;
  for (const Row& row : rows) {
    if (!row.is_done()) continue;
    const Outcome& outcome = *row.result;
    Gathered& of = gathered[row.job->calibration];
    of.all.calibration = row.job->calibration;
    of.all.rig = row.job->rig;
    ++of.all.sessions;
    if (outcome.change && regression_weight(*outcome.change) > 0) ++of.all.worse;
    if (speaks_against_lights(outcome)) ++of.all.warned;
    if (outcome.left_out) of.left_out.push_back(*outcome.left_out);
    if (outcome.change) of.turned += outcome.change->mean_deg, ++of.compared;
  }
  std::vector<ByCalibration> all;
  for (auto& [id, of] : gathered) {
    if (!of.left_out.empty()) of.all.left_out = median(std::move(of.left_out));
    if (of.compared > 0) of.all.mean_turn_deg = of.turned / of.compared;
    all.push_back(std::move(of.all));
  }
  std::vector<double> left_out;
  for (const ByCalibration& each : all) {
    if (each.left_out) left_out.push_back(*each.left_out);
  }
  const double usual = left_out.empty() ? 0 : lower_quantile(std::move(left_out), 0.5);
  for (ByCalibration& each : all) {
    if (each.left_out && *each.left_out > kStandsOut * usual) each.usual_left_out = usual;
  }
  std::ranges::stable_sort(
      all, [](const ByCalibration& a, const ByCalibration& b) { return suspicion(a) > suspicion(b); });
  return all;
}

Json json_of(const Row& row) {
  Json json = {{"session", row.job->session},
               {"task", row.job->task},
               {"quality", row.job->quality},
               {"calibration", row.job->calibration},
               {"state", row.result ? kStateNames[static_cast<std::size_t>(row.result->state)] : "missing"},
               {"attempts", row.attempts},
               {"predicted_seconds", row.job->forecast.seconds},
               {"predicted_deg", row.job->forecast.degrees},
               {"predicted_solved", row.job->forecast.solved}};
  const std::optional<Outcome>& said = row.result ? row.result : row.lost;
  if (said && said->error) json["error"] = json_of(*said->error);
  if (!row.is_done()) return json;
  json["solve"] = row.result->solve;
  json["folder"] = row.result->folder;
  json["seconds"] = row.result->seconds;
  json["peak_bytes"] = row.result->peak_bytes;
  json["sigma_deg"] = row.result->sigma_deg;
  json["solved"] = row.result->solved_share();
  json["warnings"] = row.result->warnings;
  json["before"] = row.job->before;
  if (row.result->change) {
    json["change"] = json_of(*row.result->change);
    json["regressions"] = regressions(*row.result->change);
  } else if (!row.result->no_change.empty()) {
    json["no_change"] = row.result->no_change;
  }
  return json;
}

}  // namespace

std::vector<Row> rows_of(const Plan& plan, const std::map<std::string, History>& histories) {
  std::vector<Row> rows;
  rows.reserve(plan.jobs.size());
  for (const Job& job : plan.jobs) {
    const auto found = histories.find(job.session);
    if (found == histories.end()) {
      rows.push_back({&job});
    } else {
      rows.push_back({&job, found->second.result, found->second.lost, found->second.attempts});
    }
  }
  return rows;
}

Summary summarize(std::span<const Row> rows) {
  Summary summary;
  std::set<int> missing;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    count(row, summary);
    if (row.is_missing()) missing.insert(row.job->task);
    if (row.is_done() && row.result->solved_share() < kLeastSolved) summary.barely_solved.push_back(i);
    if (row.is_done() && !row.result->warnings.empty()) summary.warned.push_back(i);
    if (!row.is_done() || !row.result->change) continue;
    summary.changed.push_back(i);
    if (regression_weight(*row.result->change) > 0) ++summary.worse;
    if (row.result->change->is_none()) ++summary.unchanged;
  }
  std::ranges::stable_sort(summary.changed, [&](std::size_t a, std::size_t b) {
    return is_graver(*rows[a].result->change, *rows[b].result->change);
  });
  summary.causes = causes_of(rows);
  summary.calibrations = by_calibration(rows);
  summary.missing_tasks.assign(missing.begin(), missing.end());
  return summary;
}

Json json_of(const Summary& s, std::span<const Row> rows) {
  Json causes = Json::array(), calibrations = Json::array(), changed = Json::array(),
       barely_solved = Json::array(), warned = Json::array(), sessions = Json::array();
  for (const Cause& cause : s.causes)
    causes.push_back({{"kind", cause.kind},
                      {"what", cause.what},
                      {"sessions", cause.sessions},
                      {"example", cause.example}});
  for (const ByCalibration& c : s.calibrations)
    calibrations.push_back({{"calibration", c.calibration},
                            {"rig", c.rig},
                            {"sessions", c.sessions},
                            {"worse", c.worse},
                            {"warned", c.warned},
                            {"mean_turn_deg", c.mean_turn_deg ? Json(*c.mean_turn_deg) : Json()},
                            {"left_out", c.left_out ? Json(*c.left_out) : Json()}});
  for (const auto& [of, names] :
       {std::pair{&s.changed, &changed}, {&s.barely_solved, &barely_solved}, {&s.warned, &warned}}) {
    for (const std::size_t i : *of) names->push_back(rows[i].job->session);
  }
  for (const Row& row : rows) sessions.push_back(json_of(row));
  return {{"solved", s.solved},
          {"there", s.there},
          {"failed", s.failed},
          {"missing", s.missing},
          {"second_attempts", s.second_attempts},
          {"seconds", s.seconds},
          {"predicted_seconds", s.predicted_seconds},
          {"seconds_ratio", s.seconds_ratio()},
          {"mean_deg", s.error.degrees()},
          {"mean_solved", s.error.solved()},
          {"predicted_deg", s.predicted_error.degrees()},
          {"predicted_solved", s.predicted_error.solved()},
          {"barely_solved", std::move(barely_solved)},
          {"warned", std::move(warned)},
          {"peak_bytes", s.peak_bytes},
          {"causes", std::move(causes)},
          {"calibrations", std::move(calibrations)},
          {"worse", s.worse},
          {"unchanged", s.unchanged},
          {"changed", std::move(changed)},
          {"missing_tasks", s.missing_tasks},
          {"sessions", std::move(sessions)}};
}

}  // namespace weft::batch
