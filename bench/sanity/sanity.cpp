// SPDX-License-Identifier: Apache-2.0
#include "bench/sanity/sanity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "solve/run/solve_session.h"

namespace weft::bench {
namespace {

bool has_any(const std::string& text, const std::vector<const char*>& words) {
  return std::ranges::any_of(words, [&](const char* word) { return text.find(word) != std::string::npos; });
}

// Verdicts on what the cloth is rather than on what it is taken for.
bool is_of_cloth(const std::string& name) {
  return name == "SPECULAR_DOMINATED" || name == "EXPOSURE" || name == "SHADOWS_CAPPED";
}

SetOutcome judge(const SetFault& fault, const SolveFacts& facts) {
  SetOutcome outcome;
  bool is_named = false, is_other = false;
  for (const Verdict& verdict : facts.warnings) {
    outcome.said += (outcome.said.empty() ? "" : " ") + verdict.name;
    const bool names_it =
        std::ranges::any_of(fault.verdicts, [&](const char* n) { return verdict.name == n; });
    is_named = is_named || names_it;
    is_other = is_other || (!names_it && !is_of_cloth(verdict.name));
  }
  bool is_mended = false;
  for (const std::string& words : facts.assumed) {
    const bool mends = has_any(words, fault.words);
    is_mended = is_mended || mends;
    const bool is_doubt = has_any(words, {"taken as clipped", "since left-out light"});
    is_other = is_other || (is_doubt && !mends);
    if (is_doubt) outcome.said += " (" + words.substr(0, 40) + ")";
  }
  outcome.told = is_named    ? Told::kNamed
                 : is_mended ? Told::kMended
                 : is_other  ? Told::kOtherwise
                             : Told::kNot;
  return outcome;
}

constexpr std::array<const char*, 4> kTold = {"named", "mended", "otherwise", "not told"};

Json row_of(const SetFault& fault, const std::vector<SetOutcome>& outcomes) {
  std::array<int, 4> counts = {};
  std::map<std::string, int> others;
  for (const SetOutcome& outcome : outcomes) {
    ++counts[static_cast<std::size_t>(outcome.told)];
    if (outcome.told == Told::kOtherwise) ++others[outcome.said];
  }
  Json row = {{"fault", fault.name}, {"sets", outcomes.size()}};
  for (std::size_t i = 0; i < kTold.size(); ++i) row[kTold[i]] = counts[i];
  std::string said;
  for (const auto& [words, times] : others)
    said += fmt::format("{}{} {}", said.empty() ? "" : ", ", words, times);
  row["said otherwise"] = said;
  return row;
}

}  // namespace

Result<SetOutcome> outcome_of(const SetFault& fault, std::uint32_t seed) {
  const TemporaryFolder folder;
  Draws draws(seed ^ 0x80000000U);
  DrawnSet set = draw_set(seed);
  fault.make(set, draws);
  const Result<solve::PhotoOptions> input = write_set(set, folder.path(), draws);
  if (!input) return input.error();
  JobContext context;
  context.threads = 1;
  const Result<solve::SolveReport> report = solve::solve_photos(
      *input, {.method = "fast", .output = folder.path() / "solve", .previews = false}, context);
  if (report) return judge(fault, report->facts);
  const std::string said = report.error().message();
  return SetOutcome{has_any(said, fault.words) ? Told::kNamed : Told::kOtherwise, said};
}

Result<Rows> sanity_table(const SanityOptions& asked, const StudyOptions& options) {
  Rows rows;
  int done = 0;
  const std::vector<SetFault>& faults = set_faults();
  for (const SetFault& fault : faults) {
    if (!asked.fault.empty() && asked.fault != fault.name) continue;
    std::vector<std::optional<Result<SetOutcome>>> outcomes(static_cast<std::size_t>(options.runs));
    parallel_for(outcomes.size(), options.threads, [&](std::size_t i, int) {
      outcomes[i] = outcome_of(fault, static_cast<std::uint32_t>(options.seed + i));
    });
    std::vector<SetOutcome> all;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (!*outcomes[i]) return outcomes[i]->error();
      all.push_back(std::move(**outcomes[i]));
      if (asked.lists)
        rows.push_back({{"fault", fault.name},
                        {"seed", options.seed + i},
                        {"told", kTold[static_cast<std::size_t>(all.back().told)]},
                        {"said", all.back().said}});
    }
    if (!asked.lists) rows.push_back(row_of(fault, all));
    options.progress(++done, static_cast<int>(faults.size()));
  }
  return rows;
}

}  // namespace weft::bench
