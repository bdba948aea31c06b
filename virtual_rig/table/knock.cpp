// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/table/knock.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "simulator/scene/scene_rig.h"
#include "virtual_rig/table/said.h"

namespace weft::virtual_rig {
namespace {

using simulator::PoseSettings;

constexpr Sayable kAlongX = {"x", -1000, 1000, 0}, kAlongY = {"y", -1000, 1000, 0},
                  kAlongZ = {"z", -1000, 1000, 0}, kTurned = {"turn", -45, 45, 0},
                  kTilted = {"tilt", 0, 45, 0}, kTowards = {"azimuth", -360, 360, 0};

Error not_knocked(const std::string& word, const std::string& why) {
  return {ErrorKind::kUsage, "that cannot be knocked", word, why,
          "say knock camera x= y= turn= tilt= azimuth=, knock led LED x= y= z=, knock table x= y= z=, or "
          "knock nothing"};
}

Result<void> knock_camera(Knocks& knocks, const std::vector<std::string>& of_it) {
  const Result<SaidValues> said = SaidValues::of(of_it, {kAlongX, kAlongY, kTurned, kTilted, kTowards});
  if (!said) return said.error();
  knocks.camera = {.tilt_deg = (*said)(kTilted),
                   .azimuth_deg = (*said)(kTowards),
                   .roll_deg = (*said)(kTurned),
                   .x_mm = (*said)(kAlongX),
                   .y_mm = (*said)(kAlongY)};
  return {};
}

Result<void> knock_led(Knocks& knocks, const std::vector<std::string>& words, int leds) {
  int led = 0;
  const std::string& word = words.size() > 1 ? words[1] : words[0];
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), led);
  if (wrong != std::errc() || end != word.data() + word.size() || led < 1 || led > leds)
    return not_knocked(word, fmt::format("LEDs are 1 to {}", leds));
  const Result<SaidValues> said =
      SaidValues::of({words.begin() + 2, words.end()}, {kAlongX, kAlongY, kAlongZ});
  if (!said) return said.error();
  knocks.leds_mm[led] = {(*said)(kAlongX), (*said)(kAlongY), (*said)(kAlongZ)};
  return {};
}

Result<void> knock_table(Knocks& knocks, const std::vector<std::string>& of_it) {
  const Result<SaidValues> said = SaidValues::of(of_it, {kAlongX, kAlongY, kAlongZ});
  if (!said) return said.error();
  knocks.table_mm = {(*said)(kAlongX), (*said)(kAlongY), (*said)(kAlongZ)};
  return {};
}

/// Two small tilts, one after the other.
PoseSettings together(PoseSettings pose, const PoseSettings& more) {
  constexpr double kRadians = std::numbers::pi / 180;
  const auto along = [&](double (*of)(double)) {
    return pose.tilt_deg * of(pose.azimuth_deg * kRadians) + more.tilt_deg * of(more.azimuth_deg * kRadians);
  };
  const double x_deg = along(std::cos), y_deg = along(std::sin);
  pose.tilt_deg = std::hypot(x_deg, y_deg);
  pose.azimuth_deg = std::atan2(y_deg, x_deg) / kRadians;
  pose.roll_deg += more.roll_deg;
  pose.x_mm += more.x_mm;
  pose.y_mm += more.y_mm;
  return pose;
}

}  // namespace

Result<void> knock(Knocks& knocks, const std::vector<std::string>& words, int leds) {
  if (words.size() == 1 && words[0] == "nothing") {
    knocks = {};
    return {};
  }
  if (!words.empty() && words[0] == "camera") return knock_camera(knocks, {words.begin() + 1, words.end()});
  if (!words.empty() && words[0] == "led") return knock_led(knocks, words, leds);
  if (!words.empty() && words[0] == "table") return knock_table(knocks, {words.begin() + 1, words.end()});
  return not_knocked(words.empty() ? "knock" : words[0], "it is neither camera nor led nor table");
}

Result<simulator::Scene> knocked(simulator::Scene scene, const Knocks& knocks) {
  if (knocks == Knocks()) return scene;
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();
  scene.camera.pose = together(scene.camera.pose, knocks.camera);
  scene.lights.rings.clear();
  scene.lights.leds.clear();
  for (const NearLight& led : rig->leds.leds)
    scene.lights.leds.push_back({led.position_mm, led.aim, led.mu, led.flux_rgb});
  for (const auto& [led, shift_mm] : knocks.leds_mm) {
    Vec3& position_mm = scene.lights.leds[static_cast<std::size_t>(led - 1)].position_mm;
    position_mm = position_mm + shift_mm;
  }
  for (simulator::TargetSettings& target : scene.targets)
    target.centre_mm = target.centre_mm + knocks.table_mm;
  scene.geometry.cloth_height_mm += knocks.table_mm.z;
  const Result<simulator::SceneRig> is_possible = simulator::rig_of(scene);
  if (!is_possible) return is_possible.error();
  return scene;
}

std::vector<CommandWords> knock_words() {
  return {
      {"knock camera ...",
       "the camera looks x=, y= (mm) beside where it looked, turned and tilted by turn=, tilt= (degrees), "
       "azimuth= (of the tilt)",
       "knock camera x=3 turn=0.4"},
      {"knock led LED ...", "the LED is x=, y=, z= (mm) from where it was", "knock led 3 x=6 z=-4"},
      {"knock table ...", "the table, and what lies on it, is x=, y=, z= (mm) from where it was",
       "knock table z=-2"},
      {"knock nothing", "everything is where it was", "knock nothing"}};
}

}  // namespace weft::virtual_rig
