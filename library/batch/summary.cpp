// SPDX-License-Identifier: Apache-2.0
#include "library/batch/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/base/error_kind.h"
#include "core/base/statistics.h"
#include "core/describe/error_json.h"
#include "core/solve/solve.h"

namespace weft::library {
namespace {

// What a wrong calibration makes a solve say (solve/report/solve_report.h).
constexpr std::array<std::string_view, 4> kOfCalibration = {"LIGHTS_DO_NOT_FIT", "LEDS_EXCHANGED", "LED_DEAD",
                                                            "LED_GAIN"};

bool speaks_against_lights(const TaskOutcome& outcome) {
  return std::ranges::any_of(outcome.warnings, [](const std::string& warning) {
    return std::ranges::find(kOfCalibration, std::string_view(warning)) != kOfCalibration.end();
  });
}

void count(const BatchRow& row, BatchSummary& summary) {
  if (row.attempts > 1) ++summary.second_attempts;
  if (row.has_failed()) ++summary.failed;
  if (row.is_missing()) ++summary.missing;
  if (!row.is_done()) return;
  const TaskOutcome& outcome = *row.result;
  if (outcome.state == TaskState::kThere) {
    ++summary.there;
    return;
  }
  ++summary.solved;
  summary.error.add(outcome.expected_deg, outcome.solved_share());
  summary.predicted_error.add(row.planned->forecast.degrees, row.planned->forecast.solved);
  summary.seconds += outcome.node_seconds;
  summary.predicted_seconds += row.planned->forecast.seconds;
  summary.peak_bytes = std::max(summary.peak_bytes, outcome.peak_bytes);
}

std::vector<Cause> causes_of(std::span<const BatchRow> rows) {
  std::map<std::pair<std::string, std::string>, Cause> by_name;
  for (const BatchRow& row : rows) {
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
    if (cause.example.empty()) cause.example = error ? error->message() : what + ": " + row.planned->session;
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

std::vector<ByCalibration> by_calibration(std::span<const BatchRow> rows) {
  struct Gathered {
    ByCalibration all;
    std::vector<double> left_out;
    double turned = 0;
    int compared = 0;
  };
  std::map<std::string, Gathered> gathered;
  for (const BatchRow& row : rows) {
    if (!row.is_done()) continue;
    const TaskOutcome& outcome = *row.result;
    Gathered& of = gathered[row.planned->calibration];
    of.all.calibration = row.planned->calibration;
    of.all.rig = row.planned->rig;
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

}  // namespace

std::vector<BatchRow> rows_of(const BatchPlan& plan, const std::map<std::string, TaskHistory>& histories) {
  std::vector<BatchRow> rows;
  rows.reserve(plan.solves.size());
  for (const PlannedSolve& planned : plan.solves) {
    const auto found = histories.find(planned.session);
    if (found == histories.end()) {
      rows.push_back({&planned});
    } else {
      rows.push_back({&planned, found->second.result, found->second.lost, found->second.attempts});
    }
  }
  return rows;
}

BatchSummary summarize(std::span<const BatchRow> rows) {
  BatchSummary summary;
  std::set<int> missing;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BatchRow& row = rows[i];
    count(row, summary);
    if (row.is_missing()) missing.insert(row.planned->task);
    if (row.is_done() && row.result->solved_share() < kLeastSolved) summary.barely_solved.push_back(i);
    if (!row.is_done()) continue;
    const std::optional<ScanVerdict>& verdict = row.result->verdict;
    if (verdict) ++summary.grades[static_cast<std::size_t>(verdict->grade)];
    if (verdict ? verdict->grade != Grade::kGood : !row.result->warnings.empty()) summary.warned.push_back(i);
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

void describe(Fields& fields, Cause& c) {
  fields.value({"kind", "Of the error"}, c.kind);
  fields.value({"what", "What happened"}, c.what);
  fields.value({"sessions", "How many"}, c.sessions);
  fields.value({"example", "The message of one"}, c.example);
}

void describe(Fields& fields, ByCalibration& c) {
  fields.value({"calibration", "Its id"}, c.calibration);
  fields.value({"rig", "Its name"}, c.rig);
  fields.value({"sessions", "That were solved by it"}, c.sessions);
  fields.value({"worse", "Of them with regressions"}, c.worse);
  fields.value({"warned", "Of them whose lights do not fit"}, c.warned);
  fields.value({"mean_turn_deg", "From the solves before, degrees", {}, kOrNull}, c.mean_turn_deg);
  fields.value({"left_out", "Median rms of how left-out lights are predicted, a share", {}, kOrNull},
               c.left_out);
}

namespace {

void describe_done(Fields& fields, PlannedSolve& planned, TaskOutcome& o) {
  double solved = o.solved_share();
  fields.value({"solve", "Its id"}, o.solve);
  fields.value({"folder", "Where it is"}, o.folder);
  fields.value({"seconds", "That it took"}, o.seconds);
  fields.value({"peak_bytes", "Of memory"}, o.peak_bytes);
  fields.value({"sigma_deg", "Median angle that sigma.exr predicts, degrees"}, o.sigma_deg);
  fields.value({"solved", "Share of the cloth that has a normal"}, solved);
  fields.value({"warnings", "By name"}, o.warnings);
  fields.value({"before", "Id of the solve that it is compared with; empty: none"}, planned.before);
  fields.object({"change", "From the solve before", {}, kUnlessEmpty}, o.change);
  fields.only_if(o.change.has_value(), [&] {
    std::vector<std::string> worse = o.change ? regressions(*o.change) : std::vector<std::string>();
    fields.value({"regressions", "In what it is worse, the gravest first"}, worse);
  });
  fields.value({"no_change", "Why it could not be compared", {}, kUnlessEmpty}, o.no_change);
}

}  // namespace

void describe(Fields& fields, BatchRow& row) {
  PlannedSolve planned = row.planned != nullptr ? *row.planned : PlannedSolve();
  TaskOutcome outcome = row.result.value_or(row.lost.value_or(TaskOutcome()));
  std::string state = row.result ? kStateNames[static_cast<std::size_t>(row.result->state)] : "missing";
  fields.value({"session", "Its folder"}, planned.session);
  fields.value({"task", "From 0"}, planned.task);
  fields.value({"quality", "Level"}, planned.quality);
  fields.value({"calibration", "Its id"}, planned.calibration);
  fields.value(
      {.name = "state", .says = "What became of it", .words = {"solved", "there", "failed", "missing"}},
      state);
  fields.value({"attempts", "So far"}, row.attempts);
  fields.value({"predicted_seconds", "By the plan"}, planned.forecast.seconds);
  fields.value({"predicted_deg", "By the plan, degrees"}, planned.forecast.degrees);
  fields.value({"predicted_solved", "By the plan, a share"}, planned.forecast.solved);
  fields.object({"error", "Why it failed, or its last attempt was lost", {}, kUnlessEmpty}, outcome.error);
  fields.only_if(row.is_done(), [&] { describe_done(fields, planned, outcome); });
}

std::string grades_in_words(const BatchSummary& summary) {
  std::vector<std::string> words;
  const auto add = [&](Grade grade, const char* name) {
    if (const int count = summary.grades[static_cast<std::size_t>(grade)]; count > 0)
      words.push_back(fmt::format("{} {}", count, name));
  };
  add(Grade::kGood, "good");
  add(Grade::kUsable, "usable");
  add(Grade::kAgain, "to be taken again");
  return fmt::format("{}", fmt::join(words, ", "));
}

void describe(Fields& fields, SummaryDocument& document) {
  auto& [s, rows] = document;
  const auto names_of = [&rows = rows](const std::vector<std::size_t>& some) {
    std::vector<std::string> names;
    for (const std::size_t i : some) names.push_back(rows[i].planned->session);
    return names;
  };
  double ratio = s.seconds_ratio(), deg = s.error.degrees(), solved = s.error.solved(),
         predicted_deg = s.predicted_error.degrees(), predicted_solved = s.predicted_error.solved();
  std::vector<std::string> barely = names_of(s.barely_solved), warned = names_of(s.warned),
                           changed = names_of(s.changed);
  fields.value({"solved", "Sessions"}, s.solved);
  fields.value({"there", "Sessions whose solve was found"}, s.there);
  fields.value({"failed", "Sessions"}, s.failed);
  fields.value({"missing", "Sessions that have no result"}, s.missing);
  fields.value({"second_attempts", "Sessions that were begun more than once"}, s.second_attempts);
  fields.value({"seconds", "Node-seconds of those solved"}, s.seconds);
  fields.value({"predicted_seconds", "Of them, by the plan"}, s.predicted_seconds);
  fields.value({"seconds_ratio", "Predicted over taken"}, ratio);
  fields.value({"mean_deg", "Mean error to expect, degrees"}, deg);
  fields.value({"mean_solved", "Mean share of the cloth that has a normal"}, solved);
  fields.value({"predicted_deg", "By the plan, degrees"}, predicted_deg);
  fields.value({"predicted_solved", "By the plan, a share"}, predicted_solved);
  fields.value({"barely_solved", "Sessions of which less than half is solved"}, barely);
  fields.value({"warned", "Sessions whose verdict is not good"}, warned);
  fields.value({"good", "Sessions whose verdict is good"}, s.grades[static_cast<std::size_t>(Grade::kGood)]);
  fields.value({"usable", "Sessions that are usable"}, s.grades[static_cast<std::size_t>(Grade::kUsable)]);
  fields.value({"take_again", "Sessions to be taken again"},
               s.grades[static_cast<std::size_t>(Grade::kAgain)]);
  fields.value({"peak_bytes", "Of memory, of the largest"}, s.peak_bytes);
  fields.list({"causes", "Of failures and missing ones, the most frequent first"}, s.causes);
  fields.list({"calibrations", "The most suspect first"}, s.calibrations);
  fields.value({"worse", "Sessions with regressions"}, s.worse);
  fields.value({"unchanged", "Sessions without a changed pixel"}, s.unchanged);
  fields.value({"changed", "Sessions that were compared, the gravest first"}, changed);
  fields.value({"missing_tasks", "With a missing session, rising"}, s.missing_tasks);
  fields.list({"sessions", "One each"}, rows);
}

}  // namespace weft::library
