// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "simulator/effects/bounds.h"

namespace weft::simulator {
namespace {

using Flag = bool EffectSettings::*;
constexpr std::pair<Flag, Flag> kNeededBy[] = {
    {&EffectSettings::near_light, &EffectSettings::relief},
    {&EffectSettings::near_light, &EffectSettings::finite_led},
    {&EffectSettings::near_light, &EffectSettings::vignetting},
    {&EffectSettings::relief, &EffectSettings::cast_shadows},
    {&EffectSettings::relief, &EffectSettings::interreflection},
};

bool is_needed(Flag effect, const EffectSettings& on) {
  return std::any_of(std::begin(kNeededBy), std::end(kNeededBy),
                     [&](const auto& pair) { return pair.first == effect && on.*pair.second; });
}

/// What takes nearly all of the time where it runs, the dearest first.
constexpr bool EffectSettings::*kDearest[] = {&EffectSettings::interreflection, &EffectSettings::movement,
                                              &EffectSettings::cast_shadows, &EffectSettings::finite_led};

}  // namespace

EffectSettings effects_within(const Scene& scene, const SceneRig& rig, double to_sigma,
                              std::vector<LeftOutEffect>& left_out) {
  const std::span<const EffectKey> keys = effect_keys();
  const EffectBounds bounds = bounds_of(scene, rig);
  EffectSettings on;
  for (const EffectKey& key : keys) on.*key.on = true;
  double sum = 0;
  const auto may_go = [&](std::size_t i) {
    return on.*keys[i].on && !is_needed(keys[i].on, on) && std::isfinite(bounds[i].sigma) &&
           sum + bounds[i].sigma <= to_sigma;
  };
  const auto leave_out = [&](std::size_t i) {
    sum += bounds[i].sigma;
    on.*keys[i].on = false;
    left_out.push_back({keys[i].name, bounds[i].why, bounds[i].sigma});
  };
  for (const auto dear : kDearest) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i].on == dear && may_go(i)) leave_out(i);
    }
  }
  for (;;) {
    std::optional<std::size_t> least;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (may_go(i) && (!least || bounds[i].sigma < bounds[*least].sigma)) least = i;
    }
    if (!least) return on;
    leave_out(*least);
  }
}

}  // namespace weft::simulator
