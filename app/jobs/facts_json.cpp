// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/facts_json.h"

#include <utility>

#include "core/vec.h"

namespace weft::app {
namespace {

const char* verdict_of(const pipeline::ShotShift& shot, bool found) {
  if (!found) return "not registered";
  if (shot.verdict == pipeline::ShiftVerdict::kCorrected) return "corrected";
  return shot.verdict == pipeline::ShiftVerdict::kFlagged ? "flagged" : "still";
}

}  // namespace

Json json_of(const solver::Gates& gates) {
  Json all = Json::array();
  for (const solver::Gate& gate : gates.measured()) {
    all.push_back({{"name", gate.name},
                   {"value", gate.value},
                   {"limit", gate.limit},
                   {"unit", gate.unit},
                   {"verdict", gate.is_over ? "over" : "under"}});
  }
  return all;
}

Json json_of(const solver::SolveTally& tally) {
  return {{"float32", tally.by_kernel}, {"double", tally.by_normal_equations},
          {"qr", tally.by_qr},          {"svd", tally.by_svd},
          {"unsolved", tally.unsolved}, {"rejected_readings", tally.rejected_readings}};
}

Json json_of(const pipeline::ReferenceFacts& facts) {
  Json stages = Json::array(), rounds = Json::array();
  if (facts.stages.shadows) stages.push_back("shadows");
  if (facts.stages.interreflection) stages.push_back("interreflection");
  for (const pipeline::ReferenceRound& round : facts.rounds)
    rounds.push_back({{"turned_deg", round.turned_deg}});
  return {{"stages", std::move(stages)},
          {"rounds", std::move(rounds)},
          {"shadow_reach_is_capped", facts.shadow_reach_is_capped}};
}

Json json_of(const pipeline::SessionShifts& shifts, const std::vector<int>& leds) {
  Json list = Json::array();
  for (std::size_t k = 0; k < shifts.shots.size(); ++k) {
    const pipeline::ShotShift& shot = shifts.shots[k];
    const solver::ShotRegistration& m = shot.measured;
    list.push_back({{"led", k < leds.size() ? leds[k] : static_cast<int>(k) + 1},
                    {"dx_px", m.shift.dx_px},
                    {"dy_px", m.shift.dy_px},
                    {"turn_deg", degrees(m.shift.turn)},
                    {"sigma_px", m.sigma_px},
                    {"cost_deg", m.cost_deg},
                    {"corrected", shot.verdict == pipeline::ShiftVerdict::kCorrected},
                    {"verdict", verdict_of(shot, shifts.found)}});
  }
  return list;
}

}  // namespace weft::app
