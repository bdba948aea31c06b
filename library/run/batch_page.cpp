// SPDX-License-Identifier: Apache-2.0
#include "library/run/batch_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "core/solve/solve.h"
#include "solve/report/solve_report.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRows = 200;  // of a table on the page; report.json has all

std::string name_in(const std::string& session) {
  return fs::path(session).stem().string();
}

std::string number(const std::optional<double>& value, const char* format = "{:.3g}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "";
}

// As people call it, and by its session.
std::string cloth_in(const PlannedSolve& planned) {
  const std::string name = name_in(planned.session);
  return planned.fabric.empty() || planned.fabric == name ? name
                                                          : fmt::format("{}, {}", planned.fabric, name);
}

std::string sessions_in_words(int count) {
  return fmt::format("{} session{}", count, count == 1 ? "" : "s");
}

// Whether it shows as many as it may, and then says so.
bool is_full(report::Section& section) {
  if (section.table->rows.size() < kMostRows) return false;
  section.paragraphs.push_back(fmt::format("The first {} are shown; report.json has all.", kMostRows));
  return true;
}

report::Section done_section(const BatchState& state) {
  const BatchSummary& s = state.summary;
  const BatchHeader& header = state.plan.header;
  report::Section section = {.title = "What was done"};
  const double hours = s.seconds / 3600, predicted = s.predicted_seconds / 3600;
  section.table = report::Table{
      .rows = {{"planned", std::to_string(header.sessions)},
               {"solved", std::to_string(s.solved)},
               {"solved before", std::to_string(s.there)},
               {"good, usable, to be taken again", grades_in_words(s)},
               {"failed", std::to_string(s.failed)},
               {"missing", std::to_string(s.missing)},
               {"begun more than once", std::to_string(s.second_attempts)},
               {"node-hours", fmt::format("{:.3g}", hours)},
               {"node-hours predicted of these",
                predicted > 0 ? fmt::format("{:.3g}, {:.2f} times what it took", predicted, s.seconds_ratio())
                              : ""},
               {"mean error expected", error_in_words(s.error.degrees(), s.error.solved())},
               {"mean error planned",
                header.sampled > 0 ? error_in_words(s.predicted_error.degrees(), s.predicted_error.solved())
                                   : "none was foretold"},
               {"largest memory, MB", std::to_string(s.peak_bytes >> 20)},
               {"left out by the plan", std::to_string(header.left_out)}}};
  return section;
}

report::Section causes_section(const BatchState& state) {
  if (state.summary.causes.empty()) return {};
  report::Section section = {.title = "What is not solved, by cause"};
  section.table = report::Table{.header = {"cause", "kind", "sessions", "one of them"}};
  for (const Cause& cause : state.summary.causes)
    section.table->rows.push_back({cause.what, cause.kind, std::to_string(cause.sessions), cause.example});
  return section;
}

report::Section warned_section(const BatchState& state) {
  if (state.summary.warned.empty()) return {};
  report::Section section = {.title = "Solved, and not all is well"};
  section.table = report::Table{.header = {"session", "verdict", "to do", "warnings"}};
  for (const std::size_t index : state.summary.warned) {
    if (is_full(section)) break;
    const TaskOutcome& outcome = *state.rows[index].result;
    const ScanVerdict verdict = outcome.verdict.value_or(
        ScanVerdict{Grade::kUsable, error_in_words(outcome.expected_deg, outcome.solved_share()), ""});
    if (verdict.grade == Grade::kAgain) section.table->alarms.insert(section.table->rows.size());
    section.table->rows.push_back({name_in(outcome.session),
                                   words_of(ScanVerdict{verdict.grade, verdict.says, ""}), verdict.action,
                                   fmt::format("{}", fmt::join(outcome.warnings, ", "))});
  }
  return section;
}

report::Section frames_section(const BatchState& state) {
  report::Section section = {.title = "Frames that lie"};
  section.table = report::Table{.header = {"session", "what was found, what it would cost, what was done"}};
  for (const BatchRow& row : state.rows) {
    if (!row.result) continue;
    for (const std::string& said : row.result->frames) {
      if (is_full(section)) break;
      section.table->rows.push_back({name_in(row.result->session), said});
    }
  }
  if (section.table->rows.empty()) return {};
  return section;
}

report::Section calibrations_section(const BatchState& state) {
  report::Section section = {.title = "By calibration, the most suspect first"};
  section.table = report::Table{.header = {"calibration", "rig", "sessions", "worse", "lights do not fit",
                                           "left-out lights, % off", "turned by, degrees"}};
  for (const ByCalibration& c : state.summary.calibrations) {
    if (c.worse + c.warned > 0) section.table->alarms.insert(section.table->rows.size());
    section.table->rows.push_back({c.calibration.substr(0, 12), c.rig, std::to_string(c.sessions),
                                   std::to_string(c.worse), std::to_string(c.warned),
                                   c.left_out ? fmt::format("{:.2f}", 100 * *c.left_out) : "",
                                   number(c.mean_turn_deg)});
  }
  return section;
}

std::vector<std::string> row_of_change(const BatchRow& row) {
  const MapChange& change = *row.result->change;
  const auto pair = [](const std::optional<BeforeAfter>& p) {
    return p ? fmt::format("{:.3g} → {:.3g}", p->before, p->after) : std::string();
  };
  return {cloth_in(*row.planned),
          fmt::format("{:.3g}", change.mean_deg),
          fmt::format("{:.3g}", change.p95_deg),
          fmt::format("{:.3g}", change.max_deg),
          fmt::format("{:+.2f} %", 100 * change.albedo_bias_rel),
          pair(change.sigma_deg),
          fmt::format("{:.2f} → {:.2f} %", 100 * change.unsolved.before, 100 * change.unsolved.after),
          fmt::format("{}", fmt::join(regressions(change), "; "))};
}

report::Section changes_section(const BatchState& state) {
  const BatchSummary& s = state.summary;
  report::Section section = {.title = "The change from the solve before"};
  if (s.changed.empty()) {
    section.paragraphs.push_back("No session had a solve that the new one could be compared with.");
    return section;
  }
  section.paragraphs.push_back(fmt::format("{} compared, {} worse in something, {} without a changed pixel.",
                                           s.changed.size(), s.worse, s.unchanged));
  if (s.unchanged == static_cast<int>(s.changed.size())) section.paragraphs.push_back("No pixel changed.");
  section.table = report::Table{.header = {"session", "mean, degrees", "95 % under", "most", "albedo",
                                           "sigma, degrees", "unsolved", "worse in"}};
  section.is_answer = true;
  for (const std::size_t index : s.changed) {
    if (is_full(section)) break;
    const BatchRow& row = state.rows[index];
    if (regression_weight(*row.result->change) > 0) section.table->alarms.insert(section.table->rows.size());
    section.table->rows.push_back(row_of_change(row));
  }
  return section;
}

report::Section left_out_section(const BatchState& state) {
  if (state.plan.left_out.empty()) return {};
  report::Section section = {.title = "Left out by the plan"};
  section.table = report::Table{.header = {"session", "why", ""}};
  for (const SkippedSession& left : state.plan.left_out) {
    if (is_full(section)) break;
    section.table->rows.push_back(
        {name_in(left.session), kReasonNames[static_cast<std::size_t>(left.reason)], left.said});
  }
  return section;
}

// The calibration that speaks against itself: its sessions became worse, their lights do not fit, or left-out
// lights are off by much more than with the others.
std::optional<Verdict> suspect(const BatchSummary& summary) {
  if (summary.calibrations.empty()) return {};
  const ByCalibration& first = summary.calibrations.front();
  const bool is_worse = 2 * first.worse >= first.sessions && first.worse > 0;
  const bool is_warned = 2 * first.warned >= first.sessions && first.warned > 0;
  const bool stands_out = first.usual_left_out.has_value();
  if (!is_worse && !is_warned && !stands_out) return {};
  std::vector<std::string> said;
  if (is_worse) said.push_back(fmt::format("{} of {} sessions became worse", first.worse, first.sessions));
  if (is_warned)
    said.push_back(fmt::format("the lights of {} of {} do not fit", first.warned, first.sessions));
  if (stands_out)
    said.push_back(fmt::format("left-out lights are {:.2g} percent off, as a rule {:.2g}",
                               100 * *first.left_out, 100 * *first.usual_left_out));
  return Verdict{
      "CALIBRATION_SUSPECT",
      fmt::format("calibration {:.12} of rig {}: {}", first.calibration, first.rig, fmt::join(said, ", ")),
      "check the rig's calibration before its solves are accepted"};
}

}  // namespace

std::vector<Verdict> verdicts_of(const BatchState& state) {
  const BatchSummary& s = state.summary;
  std::vector<Verdict> verdicts;
  if (std::optional<Verdict> calibration = suspect(s)) verdicts.push_back(std::move(*calibration));
  if (s.missing > 0)
    verdicts.push_back(
        {"MISSING",
         fmt::format("{} of {} have no result", sessions_in_words(s.missing), state.plan.header.sessions),
         "run the same command again, or submit what is missing"});
  if (s.failed > 0)
    verdicts.push_back({"FAILED", fmt::format("{} failed", sessions_in_words(s.failed)),
                        "put right what the causes say, then run with --retry-failed, or plan again"});
  if (!s.barely_solved.empty()) {
    std::vector<std::string> named;
    for (const std::size_t i : s.barely_solved)
      named.push_back(fmt::format("{} ({})", name_in(state.rows[i].planned->session),
                                  share_in_words(state.rows[i].result->solved_share())));
    verdicts.push_back(
        {"BARELY_SOLVED",
         fmt::format("{} solved on less than half of the cloth: {}",
                     sessions_in_words(static_cast<int>(named.size())), fmt::join(named, ", ")),
         "look at the warnings of these solves; scan again what is too bright or too dark"});
  }
  const auto lie = std::ranges::count_if(
      state.rows, [](const BatchRow& row) { return row.result && !row.result->frames.empty(); });
  if (lie > 0)
    verdicts.push_back({"FRAMES_LIE",
                        fmt::format("{} have frames that lie: the report names each and what was done",
                                    sessions_in_words(static_cast<int>(lie))),
                        "scan these again where what is left of them is not enough"});
  if (s.worse > 0)
    verdicts.push_back({"WORSE", fmt::format("{} became worse", sessions_in_words(s.worse)),
                        "look at them first; weft batch accept leaves them as they are"});
  return verdicts;
}

std::vector<report::Section> sections_of(const BatchState& state) {
  return {frames_section(state),       done_section(state),    causes_section(state),  warned_section(state),
          calibrations_section(state), changes_section(state), left_out_section(state)};
}

std::string batch_page(const BatchState& state, const std::vector<DrawnChange>& drawn) {
  const BatchSummary& s = state.summary;
  const BatchHeader& header = state.plan.header;
  report::Page page = {.title = fmt::format("Batch {}", header.id),
                       .meta = {fmt::format("{}: {} of {} solved", header.archive, s.solved + s.there,
                                            sessions_in_words(header.sessions))},
                       .verdicts = verdicts_of(state),
                       .sections = sections_of(state)};
  if (page.verdicts.empty()) page.summary = "All is solved, and nothing became worse.";
  const auto answer = std::ranges::find(page.sections, true, &report::Section::is_answer);
  for (const DrawnChange& each : drawn) {
    if (answer == page.sections.end()) break;
    answer->figures.push_back(
        {name_in(each.session) + ": before, after, after relit, change", report::Png{each.png}});
  }
  return html_of(page);
}

}  // namespace weft::library
