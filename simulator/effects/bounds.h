// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simulator/effects/passes.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"

// What an effect can change at most, found from the scene's numbers without rendering: what `effects =
// "auto"` leaves out by. Bounds hold in every sample of every shot, whatever other effects run, so the bounds
// of several effects add up. Scene::effects is not looked at.
//
// Signals are compared where noise is drawn, between 0 and full scale, to which the converter clips them: the
// sigma of a change is sqrt(s N + r^2) / N, with N electrons at full scale, r of read noise and s the
// brighter of the two signals. What comes after noise bends noise and change alike; its own bounds are of
// what it does to such a signal. Normal deviates count as 8.6, which none exceeds
// (simulator/sampling/random.h), and the share of the rays that meet the cloth as six standard deviations
// above its mean.

namespace weft::simulator {

/// What an effect can change at most, in sigma of the noise.
struct EffectBound {
  double sigma = 0;  ///< from 0; infinite where nothing bounds the effect
  std::string why;   ///< a sentence without its full stop
};

/// In the order of effect_keys().
using EffectBounds = std::vector<EffectBound>;

/// @param rig of the same scene, whatever effects it names
EffectBounds bounds_of(const Scene& scene, const SceneRig& rig);

/// All effects but those whose bounds together stay within `to_sigma`, the least first; `left_out` gets
/// these. An effect stays while one that needs it does: near_light for relief, finite_led and vignetting,
/// relief for cast_shadows and interreflection. Noise always stays.
EffectSettings effects_within(const Scene& scene, const SceneRig& rig, double to_sigma,
                              std::vector<LeftOutEffect>& left_out);

}  // namespace weft::simulator
