// SPDX-License-Identifier: Apache-2.0
#include "solve/run/facts_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/vec.h"

namespace weft::solve {
namespace {

const char* verdict_of(const ShotShift& shot, bool found) {
  if (!found) return "not registered";
  if (shot.verdict == ShiftVerdict::kLeftOut) return "left out";
  return shot.verdict == ShiftVerdict::kFlagged ? "flagged" : "still";
}

std::vector<std::string> names_of(const LightStages& stages) {
  std::vector<std::string> names;
  if (stages.shadows) names.emplace_back("shadows");
  if (stages.interreflection) names.emplace_back("interreflection");
  return names;
}

template <typename Gain>
LeftOutGain gain_of(const Gain& gain) {
  return {gain.mean, gain.sigma, static_cast<std::int64_t>(gain.patches)};
}

}  // namespace

std::vector<GateFacts> facts_of(const solver::Gates& gates) {
  std::vector<GateFacts> all;
  for (const solver::Gate& gate : gates.measured())
    all.push_back({gate.name, gate.unit, gate.value, gate.limit, gate.is_over});
  return all;
}

SolvedBy facts_of(const solver::SolveTally& tally) {
  return {tally.by_kernel, tally.by_normal_equations, tally.by_qr, tally.by_svd,
          tally.unsolved,  tally.rejected_readings};
}

SharpeningFacts facts_of(const DeblurFacts& facts) {
  return {facts.sigma_px, facts.mean_share};
}

ReferenceLevelFacts facts_of(const ReferenceFacts& facts) {
  ReferenceLevelFacts said = {.stages = names_of(facts.stages),
                              .rounds = {},
                              .left_out = {},
                              .albedo_scale_is_open = facts.choice.scale_is_open,
                              .published = facts.robust_is_published ? "robust" : "reference",
                              .over_robust = gain_of(facts.over_robust),
                              .shadow_reach_is_capped = facts.shadow_reach_is_capped};
  for (const ReferenceRound& round : facts.rounds) {
    said.rounds.push_back({round.turned_deg, names_of(round.stages), round.stages.albedo_scale,
                           round.slope_residual_rms, round.is_refused});
  }
  for (const auto& [name, gain] : {std::pair{"shadows", facts.choice.shadows},
                                   std::pair{"interreflection", facts.choice.interreflection}}) {
    if (gain.patches > 0) said.left_out.push_back({name, gain_of(gain), gain.keeps()});
  }
  return said;
}

std::vector<std::string> warnings_of(const ReferenceFacts& facts) {
  std::vector<std::string> said;
  if (facts.choice.scale_is_open) {
    said.emplace_back(
        "light between yarns was left in: the scale of the albedo is relative and this cloth does not tell "
        "it; "
        "measure the reflectance of the paper that the lights are calibrated on");
  }
  if (facts.robust_is_published) {
    said.push_back(fmt::format(
        "the solution is that of robust: what reference takes out made left-out light harder to predict, by "
        "{:.2f} percent of the brightness",
        -100 * facts.over_robust.mean));
  }
  if (std::ranges::any_of(facts.rounds, &ReferenceRound::is_refused)) {
    said.emplace_back(
        "reference ended early: a round turned the normals no less than the one before, so its normals were "
        "not used");
  }
  return said;
}

std::vector<RegisteredShot> facts_of(const SessionShifts& shifts, const std::vector<int>& leds) {
  std::vector<RegisteredShot> list;
  for (std::size_t k = 0; k < shifts.shots.size(); ++k) {
    const ShotShift& shot = shifts.shots[k];
    const solver::ShotRegistration& m = shot.measured;
    list.push_back({k < leds.size() ? leds[k] : static_cast<int>(k) + 1, m.shift.dx_px, m.shift.dy_px,
                    degrees(m.shift.turn), m.sigma_px, m.cost_deg, shot.verdict == ShiftVerdict::kLeftOut,
                    verdict_of(shot, shifts.found)});
  }
  return list;
}

}  // namespace weft::solve
