// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"
#include "simulator/effects/led.h"

namespace weft::simulator {

Pass distant_light_pass(const Scene& scene, const SceneRig& rig) {
  const Vec3 centre_mm = {0, 0, scene.geometry.cloth_height_mm};
  std::vector<Incidence> lights;
  for (const NearLight& led : rig.leds.leds) lights.push_back(incidence(led, centre_mm));
  return {"distant light", "lights all points alike, as at the table's centre", PassStage::kLight,
          lit_by([lights = std::move(lights)](std::size_t led, Vec3) { return lights[led]; }, shading)};
}

}  // namespace weft::simulator
