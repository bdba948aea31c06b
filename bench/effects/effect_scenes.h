// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "simulator/scene/scene.h"

// What `weft bench effects` measures on.

namespace weft::bench {

using Effect = bool simulator::EffectSettings::*;

/// A plain weave of a family in two dyes and with sheen, ten pixels a yarn, under the ten default LEDs. It
/// has something for every effect and names none.
simulator::Scene cloth_scene(simulator::Family family, Size size);

/// The effect and those that it cannot do without: near_light, relief.
simulator::EffectSettings effects_for(Effect effect);
/// The same without the effect.
simulator::EffectSettings effects_under(Effect effect);
/// Every effect.
simulator::EffectSettings all_effects();

/// A white LED, three filters and two dyes, all of them Gaussians: a camera that is no observer.
void add_spectra(simulator::Scene& scene);

/// Lays a target at the table's centre, half a millimetre above it.
void lay(simulator::Scene& scene, const simulator::PatternSettings& pattern);

/// A scene of the gallery that `effects = "auto"` is tried on.
struct NamedScene {
  std::string name;
  simulator::Scene scene;
};
std::vector<NamedScene> auto_gallery(Size size);

}  // namespace weft::bench
