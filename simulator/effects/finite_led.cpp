// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"
#include "simulator/effects/led.h"

namespace weft::simulator {

Pass finite_led_pass(const Scene& scene, const SceneRig& rig) {
  const double radius_mm = scene.lights.led_radius_mm;
  return {"finite led", "lights each point from a sphere of the LED's size: soft horizon of attached shadows",
          PassStage::kLight,
          lit_by([leds = rig.leds.leds](std::size_t led,
                                        Vec3 point_mm) { return incidence(leds[led], point_mm); },
                 [radius_mm](const Incidence& light, Vec3 normal) {
                   return light.strength *
                          sphere_cosine(dot(normal, light.direction), radius_mm / light.distance_mm);
                 })};
}

}  // namespace weft::simulator
