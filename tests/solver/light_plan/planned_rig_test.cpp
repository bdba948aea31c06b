// SPDX-License-Identifier: Apache-2.0
#include "solver/light_plan/planned_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/rig/camera.h"
#include "core/rig/light_field.h"
#include "tests/solver/light_plan/ten_leds.h"

namespace weft::solver {
namespace {

constexpr Size kFrame = {33, 33};
constexpr int kMiddle = 16;

struct Moved {
  std::string name;
  double step;
  void (*move)(NearLight& led, double by);
};

const std::vector<Moved> kMoved = {
    {"position_mm.x", 0.1, [](NearLight& led, double by) { led.position_mm.x += by; }},
    {"position_mm.y", 0.1, [](NearLight& led, double by) { led.position_mm.y += by; }},
    {"position_mm.z", 0.1, [](NearLight& led, double by) { led.position_mm.z += by; }},
    {"aim.x", 1e-4,
     [](NearLight& led, double by) {
       led.aim = normalized(led.aim + Vec3{by, 0, 0});
     }},
    {"aim.z", 1e-4,
     [](NearLight& led, double by) {
       led.aim = normalized(led.aim + Vec3{0, 0, by});
     }},
    {"mu", 1e-3, [](NearLight& led, double by) { led.mu += by; }},
    {"log_flux", 1e-3,
     [](NearLight& led, double by) {
       for (double& flux : led.flux_rgb) flux *= std::exp(by);
     }},
    {"log_gain_quadratic.0", 1e-3, [](NearLight& led, double by) { led.log_gain_quadratic[0] += by; }}};

LightField::Light second_led(std::vector<NearLight> leds) {
  const auto field =
      LightField::make(NearLights{std::move(leds), {}}, overhead_camera(kFrame, 600, 1), kFrame, 0);
  EXPECT_TRUE(field) << field.error().message();
  return field->at(1, 1, kMiddle, kMiddle);
}

TEST(ForeseenRig, ErrsAsTheReadingsOfACalibrationDo) {
  std::vector<NearLight> leds = ten_leds().leds;
  leds[1].aim = normalized({0.1, -0.6, -0.8});
  leds[1].mu = 1.4;
  for (const Moved& each : kMoved) {
    const auto covariance = led_covariance_of(leds, {}, {{"led02." + each.name}, {each.step * each.step}});
    ASSERT_TRUE(covariance) << covariance.error().message();
    std::vector<NearLight> more = leds, less = leds;
    each.move(more[1], each.step);
    each.move(less[1], -each.step);
    const LightField::Light above = second_led(more), below = second_led(less);
    const double gain = std::log(above.strength / below.strength) / 2;
    const double turn = radians(angle_deg(above.direction, below.direction)) / 2;
    const auto at = [&](std::size_t i, std::size_t j) { return (*covariance)[(3 + i) * 30 + 3 + j]; };
    EXPECT_NEAR(std::sqrt(at(0, 0) - kLeastGain * kLeastGain), std::abs(gain), 1e-3 * std::abs(gain) + 1e-8)
        << each.name;
    EXPECT_NEAR(at(1, 1) + at(2, 2) - 2 * kLeastTurn * kLeastTurn, turn * turn, 1e-3 * turn * turn + 1e-12)
        << each.name;
  }
}

TEST(ForeseenRig, TakesWhatIsTypicalOfALedThatNobodyMeasured) {
  const std::vector<NearLight> leds = ten_leds().leds;
  const auto covariance = led_covariance_of(leds, {}, {{"led01.log_flux"}, {1e-4}});
  ASSERT_TRUE(covariance);
  EXPECT_NEAR((*covariance)[0], 1e-4 + kLeastGain * kLeastGain, 1e-12);
  EXPECT_NEAR((*covariance)[3 * 30 + 3], kTypicalGain * kTypicalGain + kLeastGain * kLeastGain, 1e-12);
}

TEST(ForeseenRig, RefusesACovarianceThatIsNone) {
  const std::vector<NearLight> leds = ten_leds().leds;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& matrix :
       {std::vector<double>{nan}, std::vector<double>{-1}, std::vector<double>{1, 2}}) {
    const auto covariance = led_covariance_of(leds, {}, {{"led01.log_flux"}, matrix});
    ASSERT_FALSE(covariance) << matrix.front();
    EXPECT_EQ(covariance.error().kind, ErrorKind::kBadData);
  }
}

TEST(ForeseenRig, FindsAPlaceAgainUnderATiltedCamera) {
  ForeseenRig rig = ten_leds();
  rig.camera_mm = {80, -40, 550};
  for (const LedPlace place : {LedPlace{8, 30}, LedPlace{40, 200}, LedPlace{64, 359}}) {
    const NearLight led = led_at(rig, place);
    const LedPlace again = place_of(rig, led.position_mm);
    EXPECT_NEAR(again.from_camera_deg, place.from_camera_deg, 1e-9);
    EXPECT_NEAR(again.azimuth_deg, place.azimuth_deg, 1e-9);
    EXPECT_NEAR(length(led.position_mm), 600, 1e-9);
    EXPECT_NEAR(angle_deg(led.position_mm, rig.camera_mm), place.from_camera_deg, 1e-9);
  }
}

}  // namespace
}  // namespace weft::solver
