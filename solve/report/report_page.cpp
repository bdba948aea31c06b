// SPDX-License-Identifier: Apache-2.0
#include "solve/report/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/describe/field_json.h"
#include "solve/report/left_out_report.h"
#include "solve/report/reflectance_report.h"
#include "solve/report/solve_report.h"

namespace weft::solve {
namespace {

double finite_or(double value, double otherwise = 0) {
  return std::isfinite(value) ? value : otherwise;
}

std::string percent_text(double share) {
  const double p = 100 * share;
  if (p == 0) return "0 %";
  if (p < 0.01) return "< 0.01 %";
  return fmt::format(fmt::runtime(p < 1 ? "{:.2f} %" : "{:.1f} %"), p);
}

std::string light_noun(const SolveReportFacts& report) {
  return report.is_of_photographs ? "Light" : "LED";
}

// The lights that a fault names.
std::set<int> named(const SolveReportFacts& report) {
  std::set<int> numbers;
  for (const FaultFacts& fault : report.faults) numbers.insert(fault.lights.begin(), fault.lights.end());
  return numbers;
}

std::string meta(const SolveReportFacts& report) {
  return fmt::format("solved by {} from {} lights · {} × {} pixels · {} albedo · {}", report.method,
                     report.lights.size(), report.size.width, report.size.height,
                     name_of(report.albedo_scale), report.id);
}

// What is said where nothing is to be warned of.
std::string all_is_well(const SolveReportFacts& report) {
  if (report.looked_at == 0)
    return "No pixel was bright and lit enough to hold the lights against each other.";
  if (report.lights.size() < 6)
    return "Nothing stands out. Six lights are needed to hold them against each other; here each was taken "
           "at its word.";
  return fmt::format(
      "Nothing stands out: half of the pixels agree with the model to {} of the albedo or better, and no "
      "light contradicts its calibration.",
      percent_text(finite_or(report.residual_explained)));
}

report::Section residuals(const SolveReportFacts& report) {
  const std::set<int> alarm = named(report);
  report::Table table;
  for (const LightFacts& light : report.lights) {
    const int n = light.light;
    const double size = finite_or(light.residual_median);
    if (alarm.count(n) != 0) table.alarms.insert(table.rows.size());
    table.rows.push_back({fmt::format("{} {}", light_noun(report), n), percent_text(size)});
    table.bars.push_back(size);
  }
  const double most = table.bars.empty() ? 0 : *std::ranges::max_element(table.bars);
  for (double& bar : table.bars) bar /= std::max(most, 1e-6);
  return {.title = "Residual by light",
          .table = std::move(table),
          .note = "Median deviation of the readings from a robust fit, over the albedo.",
          .is_half = true};
}

report::Section states(const SolveReportFacts& report) {
  report::Table table;
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    const double share = report.status.shares[i];
    table.rows.push_back({kStatusNames[i].name, percent_text(share)});
    table.bars.push_back(std::clamp(share, 0.0, 1.0));
  }
  return {.title = "Pixels by state",
          .table = std::move(table),
          .note = "Share of pixels with each bit of status.png; a pixel may have several.",
          .is_half = true};
}

// Predicted angle of the normal over the frame, in squares.
report::Section sigma_map(const SolveReportFacts& report) {
  const SigmaMap& sigma = report.sigma_normal_deg;
  if (!std::isfinite(sigma.median)) return {};
  report::FrameMap map = {sigma.columns, sigma.rows, {}, "°"};
  for (const Json& v : sigma.grid) map.values.push_back(v.is_number() ? v.get<double>() : NAN);
  report::Section section = {
      .title = "How well the lights fix the normal", .figures = {{"", std::move(map)}}, .is_half = true};
  section.note = fmt::format(
      "Median {:.3g}°, 95 percent below {:.3g}°. Both hold for the {} of the cloth that has a normal.",
      sigma.median, finite_or(sigma.p95), share_in_words(sigma.solved));
  if (const LightCondition& condition = report.condition; finite_or(condition.median) > 0) {
    section.note += fmt::format(" Condition number of all lights {:.2f}, at worst {:.2f}.", condition.median,
                                finite_or(condition.worst, INFINITY));
  }
  return section;
}

report::Section budget(const SolveReportFacts& report) {
  report::Table table;
  for (const ErrorSource& b : report.budget) {
    table.rows.push_back({fmt::format("{}\n{}", b.source, b.what),
                          b.unit == "deg" ? fmt::format("{:.3g}°", b.value) : percent_text(b.value / 100)});
  }
  if (const auto& error = report.error) {
    table.rows.push_back(
        {fmt::format("all of it\nmean error against the truth; 95 percent below {:.2f}°", error->p95_deg),
         fmt::format("{:.3g}°", error->mean_deg)});
  }
  return {.title = "Where the error comes from", .table = std::move(table), .is_half = true};
}

report::Section light_table(const SolveReportFacts& report) {
  const std::set<int> alarm = named(report);
  report::Table table = {{"", "rms residual", "its mean", "gain", "in shadow", "saturated", "missing",
                          "outliers", "change over the frame"}};
  for (const LightFacts& light : report.lights) {
    const int n = light.light;
    const bool is_named = alarm.count(n) != 0;
    // Very many lights are not listed but for those that are named.
    if (report.lights.size() > 24 && !is_named) continue;
    if (is_named) table.alarms.insert(table.rows.size());
    table.rows.push_back({fmt::format("{} {}", light_noun(report), n),
                          percent_text(finite_or(light.residual_rms)),
                          fmt::format("{:+.2f} %", 100 * finite_or(light.residual_mean)),
                          fmt::format("{:.1f} %", 100 * finite_or(light.gain, 1)),
                          percent_text(finite_or(light.shadowed)), percent_text(finite_or(light.saturated)),
                          percent_text(finite_or(light.missing)), percent_text(finite_or(light.outlier)),
                          fmt::format("{:.1f} % ({:.0f} %)", 100 * finite_or(light.gradient),
                                      100 * finite_or(light.gradient_share))});
  }
  return {
      .title = "Light by light",
      .table = std::move(table),
      .note = fmt::format("From {} pixels all over the frame. Gain: what the light gives of what the other "
                          "lights let expect, named faults put right. A residual that changes over the frame "
                          "and explains much of its variance (in brackets) hints that a light has moved.",
                          report.looked_at)};
}

report::Section registration(const SolveReportFacts& report) {
  report::Table table = {{"", "right, px", "down, px", "turn", "sigma, px", "costs", ""}};
  for (const RegisteredShot& shot : report.registration) {
    table.rows.push_back({fmt::format("LED {}", shot.led), fmt::format("{:+.3f}", finite_or(shot.dx_px)),
                          fmt::format("{:+.3f}", finite_or(shot.dy_px)),
                          fmt::format("{:+.4f}°", finite_or(shot.turn_deg)),
                          fmt::format("{:.3f}", finite_or(shot.sigma_px)),
                          fmt::format("{:.3f}°", finite_or(shot.cost_deg)), shot.verdict});
  }
  return {.title = "How the cloth lay in each shot", .table = std::move(table)};
}

report::Section conditions(const SolveReportFacts& report) {
  report::Table table;
  if (report.conditions) {
    ConditionFacts facts = *report.conditions;
    facts.frames.clear();
    report::add_rows(table, object_of(facts));
  }
  return {.title = "Conditions", .table = std::move(table), .is_half = true};
}

report::Section frames(const SolveReportFacts& report) {
  if (!report.conditions || report.conditions->frames.empty()) return {};
  report::Table table = {{"", "missed", "by noise", "along rows", "part that is not read", "would cost"}};
  const auto percent = [](std::optional<double> share) {
    return share ? fmt::format("{:.2f} %", 100 * *share) : "";
  };
  for (const FrameFitFacts& frame : report.conditions->frames) {
    const std::vector<int>& part = frame.part;
    table.rows.push_back(
        {fmt::format("{} {}", light_noun(report), frame.led), percent(frame.missed),
         frame.sigma > 0 ? percent(frame.sigma) : "", percent(frame.rows),
         part.size() == 4 ? fmt::format("{} to {}, {} to {}", part[0], part[2], part[1], part[3]) : "",
         frame.costs_deg ? fmt::format("{:.2g}\u00b0", *frame.costs_deg) : ""});
  }
  return {.title = "Whether each frame fits the others",
          .table = std::move(table),
          .note =
              "Missed: by what the others predict, the median over the frame, of the brightness, the frame's "
              "own gain taken off."};
}

report::Section gates(const SolveReportFacts& report) {
  report::Table table = {{"stage", "measured", "limit", "verdict"}};
  for (const GateFacts& gate : report.gates) {
    table.rows.push_back({gate.name, fmt::format("{:.3g} {}", finite_or(gate.value), gate.unit),
                          fmt::format("{:.3g} {}", finite_or(gate.limit), gate.unit),
                          gate.is_over ? "over" : "under"});
  }
  return {.title = "Gates", .table = std::move(table), .is_half = true};
}

report::Section time(const SolveReportFacts& report) {
  report::Table table;
  for (const auto& [phase, seconds] : report.seconds.items()) {
    table.rows.push_back({phase, fmt::format("{:.2f} s", seconds.get<double>())});
  }
  if (const auto& foretold = report.foretold) {
    table.rows.push_back({"foretold of all of them", fmt::format("{:.2f} s", foretold->seconds)});
    table.rows.push_back({"and for it", error_in_words(foretold->mean_deg, foretold->solved)});
  }
  return {.title = "Time by phase", .table = std::move(table), .is_half = true};
}

}  // namespace

std::string report_page(const SolveReportFacts& report, const std::vector<report::Figure>& pictures) {
  report::Page page = {.title = report.title.empty() ? "Untitled cloth" : report.title,
                       .meta = {meta(report)},
                       .verdicts = report.warnings};
  if (page.verdicts.empty()) page.summary = all_is_well(report);
  page.sections = {{.figures = pictures}, residuals(report),
                   states(report),        budget(report),
                   sigma_map(report),     reflectance_section(report.reflectance),
                   light_table(report),   left_out_section(report.check, light_noun(report)),
                   frames(report),        gates(report),
                   time(report),          conditions(report),
                   registration(report)};
  return html_of(page);
}

}  // namespace weft::solve
