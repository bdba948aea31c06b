// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"
#include "simulator/effects/led.h"

namespace weft::simulator {

Pass near_light_pass(const SceneRig& rig) {
  return {"near light", "lights each point from a LED's true place: direction, distance and lobe",
          PassStage::kLight,
          lit_by([leds = rig.leds.leds](std::size_t led,
                                        Vec3 point_mm) { return incidence(leds[led], point_mm); },
                 shading)};
}

}  // namespace weft::simulator
