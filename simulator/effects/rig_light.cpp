// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"
#include "simulator/effects/random_key.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {
namespace {

/// Brightness of the LED in a shot from 1: warming LEDs fade in a straight line over the session, and each
/// shot is a little off by itself. A LED's bracket follows its shot at once, the repeat comes after them all.
double gain_of(const LightSettings& lights, int leds, int shot, int take, std::array<std::uint32_t, 2> key) {
  const int turn = shot == leds + 1 ? leds : (shot - 1) % leds;
  const double time = leds < 2 ? 0 : static_cast<double>(turn) / (leds - 1);
  const NormalPair normal =
      normal_pair(philox({static_cast<std::uint32_t>(take - 1), 0, kFlickerStream, 0}, key));
  return (1 - lights.drift * time) * (1 + lights.flicker * normal.first);
}

/// Adds `of_led[led]` times albedo, and times what of the sky the cloth leaves open.
std::function<void(PassTile&)> even_light(std::vector<Rgb> of_led) {
  return [of_led = std::move(of_led)](PassTile& tile) {
    const Rgb light = of_led[static_cast<std::size_t>(tile.led)];
    for (std::size_t i = 0; i < tile.signal.size(); ++i) {
      const double open = tile.openness.empty() ? 1 : tile.openness[i];
      for (std::size_t c = 0; c < 3; ++c) tile.signal[i][c] += tile.albedo[i][c] * open * light[c];
    }
  };
}

/// Signal of a white surface at the table's centre that faces the LED.
std::vector<Rgb> signal_at_centre(const Scene& scene, const SceneRig& rig) {
  std::vector<Rgb> signals;
  const double exposure = rig.exposure(scene.camera.iso);
  for (const DistantLight& light : distant_lights(rig, scene.geometry.cloth_height_mm).lights) {
    const auto& e = light.irradiance_rgb;
    signals.push_back({e[0] * exposure, e[1] * exposure, e[2] * exposure});
  }
  return signals;
}

}  // namespace

Pass led_drift_pass(const Scene& scene, const SceneRig& rig) {
  return {"led drift", "fades the LEDs over the session and lets each shot flicker", PassStage::kLight,
          [lights = scene.lights, leds = static_cast<int>(rig.leds.leds.size()),
           key = random_key(scene)](PassTile& tile) {
            if (tile.led == 0) return;
            const double gain = gain_of(lights, leds, tile.shot, tile.take, key);
            for (Rgb& signal : tile.signal) {
              for (double& s : signal) s *= gain;
            }
          }};
}

Pass stray_pass(const Scene& scene, const SceneRig& rig) {
  std::vector<Rgb> of_led = {Rgb{}};
  for (Rgb light : signal_at_centre(scene, rig)) {
    for (double& l : light) l *= scene.lights.stray;
    of_led.push_back(light);
  }
  return {"stray", "adds light of the LED that comes back from the rig, evenly from all sides",
          PassStage::kLight, even_light(std::move(of_led))};
}

Pass ambient_pass(const Scene& scene, const SceneRig& rig) {
  Rgb brightest{};
  for (const Rgb& light : signal_at_centre(scene, rig)) {
    for (std::size_t c = 0; c < 3; ++c)
      brightest[c] = std::max(brightest[c], rig.room_share * scene.lights.ambient * light[c]);
  }
  return {"ambient", "adds the light of the room to every shot, the dark one too", PassStage::kShot,
          even_light(std::vector<Rgb>(rig.leds.leds.size() + 1, brightest))};
}

}  // namespace weft::simulator
