// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/session_verdict.h"

#include <fmt/format.h>

#include <utility>

#include "core/rig/exposed.h"
#include "core/rig/seen_rig.h"
#include "solve/session/current.h"

namespace weft::library {
namespace {

std::optional<SolveFacts> facts_of(const solve::ChoosableSolve& solve) {
  const Result<Json> document = read_json(solve.folder / kSolveProduct.document, kSolveProduct.schema, 1);
  if (!document) return std::nullopt;
  Result<SolveFacts> facts = solve_facts_from_json(*document);
  return facts ? std::optional(std::move(*facts)) : std::nullopt;
}

// That the rig had moved, as long as the solve is by the calibration that this is said of.
std::optional<ScanVerdict> verdict_of_rig(const Session& session, const SolveFacts* solve) {
  const std::optional<RigLookFacts> look = read_rig_look(session.folder);
  if (!look || !look->is_bad() || look->photographs != solve::digest_of_photographs(session))
    return std::nullopt;
  const std::string used = solve != nullptr && solve->input ? solve->input->calibration.value_or("") : "";
  if (!used.empty() && used != look->calibration) return std::nullopt;
  const bool is_moved = look->state == RigPlace::kMoved;
  return ScanVerdict{Grade::kUsable, "rig: " + look->says,
                     look->action + (is_moved ? ", then solve it by that" : "")};
}

ScanVerdict verdict_by(const Session& session, const SolveFacts* solve, bool is_preview) {
  if (session.shots.empty() || session.state != "complete") {
    return {Grade::kUnfinished, session.shots.empty() ? "nothing was photographed" : "the scan did not end",
            "scan it again by the same name: it goes on"};
  }
  if (is_exposed_wrong(session)) return verdict_of_photographs(session);
  const SolvePrice* const taken = solve != nullptr && solve->taken ? &*solve->taken : nullptr;
  if (taken != nullptr && taken->solved < kLeastSolved)
    return {Grade::kAgain, "most of the cloth has no normal",
            "scan it again with the exposure that the meter takes"};

  const bool is_told = taken != nullptr && !is_preview;
  const std::string error = is_told ? error_in_words(taken->mean_deg, taken->solved) : "";
  std::vector<ScanVerdict> concerns;
  if (std::optional<ScanVerdict> moved = verdict_of_rig(session, solve))
    concerns.push_back(std::move(*moved));
  for (const std::string& warning : warnings_of(session))
    concerns.push_back(verdict_of_warning(Grade::kUsable, warning));
  if (solve != nullptr) {
    for (const Verdict& warning : solve->warnings)
      concerns.push_back({Grade::kUsable, warning.text, warning.remedy});
  }
  if (concerns.empty()) {
    const bool is_good = !is_told || (taken->mean_deg <= kGoodTo_deg && taken->solved >= kGoodFrom);
    return {is_good ? Grade::kGood : Grade::kUsable,
            is_told ? error : "nothing is wrong with its photographs", ""};
  }
  ScanVerdict first = std::move(concerns.front());
  if (is_told) first.says = error + "; " + first.says;
  if (concerns.size() > 1) first.says += fmt::format(", and {} more", concerns.size() - 1);
  return first;
}

}  // namespace

ScanVerdict verdict_of(const Session& session) {
  const solve::SessionSolves solves = solve::solves_of(session);
  const solve::ChoosableSolve* const current = solves.current_one();
  const std::optional<SolveFacts> facts = current == nullptr ? std::nullopt : facts_of(*current);
  return verdict_by(session, facts ? &*facts : nullptr, current != nullptr && current->is_preview());
}

ScanVerdict verdict_with(const Session& session, const SolveFacts& solve) {
  return verdict_by(session, &solve, false);
}

}  // namespace weft::library
