// SPDX-License-Identifier: Apache-2.0
#include "solve/report/left_out_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/base/percent.h"

namespace weft::solve {
namespace {

std::optional<double> known(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

LeftOutShares shares_of(const solver::LeftOutError& error) {
  return {error.median, error.rms, known(error.noise_median), known(error.noise_rms),
          static_cast<std::int64_t>(error.readings)};
}

std::string percent_of(const std::optional<double>& share) {
  return share ? fmt::format("{:.2f} %", 100 * *share) : "";
}

std::vector<std::string> row_of(const std::string& name, const LeftOutShares& shares) {
  return {name, percent_of(shares.median), percent_of(shares.noise_median), percent_of(shares.rms),
          percent_of(shares.noise_rms)};
}

}  // namespace

std::optional<LeftOutFacts> facts_of(const solver::LeftOut& left_out, const std::vector<int>& numbers) {
  LeftOutFacts facts;
  facts.all = shares_of(solver::error_of_all(left_out));
  if (facts.all.readings == 0) return std::nullopt;
  for (std::size_t k = 0; k < left_out.lights; ++k) {
    const LeftOutShares shares = shares_of(solver::error_of_light(left_out, k));
    if (shares.readings > 0) facts.lights.push_back({numbers[k], shares});
  }
  return facts;
}

std::optional<Verdict> verdict_of(const LeftOutFacts& facts, bool of_session,
                                  std::optional<solver::Level> level) {
  const LeftOutShares& all = facts.all;
  if (all.median < kWorstFit || all.median < kOverNoise * all.noise_median.value_or(0)) return std::nullopt;
  Verdict verdict = {
      "LIGHTS_DO_NOT_FIT",
      fmt::format("The lights do not fit together: the reading of a light that is left out is "
                  "missed by {} percent (median)",
                  all.median > 1 ? "over 100" : percent_words(all.median)),
      of_session
          ? "check that this calibration is the rig's and calibrate the lights again"
          : "check how values follow light (--transfer), the exposures, and the strengths and directions "
            "of the lights (x to the right, y up; z is towards the camera)"};
  if (all.noise_median) verdict.text += fmt::format(", where noise gives {:.1f}", 100 * *all.noise_median);
  if (level && *level < solver::Level::kRobust)
    verdict.remedy += "; if the cloth shines, solve with --quality robust";
  return verdict;
}

report::Section left_out_section(const std::optional<LeftOutFacts>& facts, const std::string& noun) {
  if (!facts) return {};
  report::Table table = {{"", "median", "by noise", "rms", "by noise"}};
  table.rows.push_back(row_of("all", facts->all));
  for (const LeftOutLight& light : facts->lights) {
    table.rows.push_back(row_of(fmt::format("{} {}", noun, light.light), light.shares));
  }
  return {.title = "Lights left out and predicted",
          .table = std::move(table),
          .note = fmt::format(
              "Each light was left out in turn and its reading predicted from the others, on patches that no "
              "stage was chosen by. Median: error over the reading; rms: over the brightness of the pixel. "
              "Beside each what noise alone would give, where it is known. {}",
              kLeftOutBlindSpot)};
}

std::string left_out_words(const LeftOutFacts& facts) {
  std::string words = "  left out and predicted from the others, a reading is missed by (median, rms):";
  const auto add = [&](const std::string& name, const LeftOutShares& shares) {
    words += fmt::format("\n    {:8} {:>8} {:>8}", name, percent_of(shares.median), percent_of(shares.rms));
    if (shares.noise_median)
      words += fmt::format("   noise alone {:>8} {:>8}", percent_of(shares.noise_median),
                           percent_of(shares.noise_rms));
  };
  for (const LeftOutLight& light : facts.lights) add(fmt::format("light {}", light.light), light.shares);
  add("all", facts.all);
  return words + fmt::format("\n  {}", kLeftOutBlindSpot);
}

}  // namespace weft::solve
