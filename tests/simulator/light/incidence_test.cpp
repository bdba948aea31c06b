// SPDX-License-Identifier: Apache-2.0
#include "simulator/light/incidence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::simulator {
namespace {

NearLight led_at(Vec3 position_mm, double mu = 1) {
  NearLight led;
  led.position_mm = position_mm;
  led.aim = normalized(-1.0 * position_mm);
  led.mu = mu;
  return led;
}

TEST(Incidence, FallsWithTheSquareOfTheDistanceAndTheCosineOfTheSurface) {
  const double zenith = radians(35);
  const NearLight led = led_at({600 * std::sin(zenith), 0, 600 * std::cos(zenith)});
  const Incidence at_centre = incidence(led, {0, 0, 0});
  EXPECT_NEAR(at_centre.strength * 600 * 600, 1, 1e-12);
  EXPECT_NEAR(shading(at_centre, {0, 0, 1}) * 600 * 600, std::cos(zenith), 1e-12);
  EXPECT_NEAR(angle_deg(at_centre.direction, {0, 0, 1}), 35, 1e-12);
  const Incidence half_way = incidence(led, 0.5 * led.position_mm);
  EXPECT_NEAR(half_way.strength / at_centre.strength, 4, 1e-12);
}

TEST(Incidence, FollowsTheLobe) {
  // A point from which the LED is 40 degrees off its axis, on the table below a LED that looks straight down.
  const double off_mm = 600 * std::tan(radians(40));
  const double d2 = 600 * 600 + off_mm * off_mm;
  for (const double mu : {0.0, 1.0, 2.5, 30.0}) {
    const double strength = incidence(led_at({0, 0, 600}, mu), {off_mm, 0, 0}).strength;
    EXPECT_NEAR(strength * d2, std::pow(std::cos(radians(40)), mu), 1e-12) << "mu " << mu;
  }
}

TEST(Incidence, IsNoneBehindTheLed) {
  for (const double mu : {0.0, 1.0, 3.0})
    EXPECT_EQ(incidence(led_at({0, 0, 600}, mu), {10, 0, 700}).strength, 0);
}

TEST(Incidence, StaysFiniteInsideTheLed) {
  NearLight led = led_at({0, 0, 600}, 0);
  EXPECT_TRUE(std::isfinite(incidence(led, led.position_mm).strength));
  EXPECT_LE(incidence(led, {0, 0, 599.999}).strength, 1) << "nearer than 1 mm counts as 1 mm";
}

TEST(Shading, IsNoneOnASurfaceThatFacesAway) {
  const Incidence light = incidence(led_at({0, 0, 600}), {0, 0, 0});
  EXPECT_EQ(shading(light, {0, 0, -1}), 0);
  EXPECT_EQ(shading(light, normalized({1, 0, -0.01})), 0);
  EXPECT_GT(shading(light, normalized({1, 0, 0.01})), 0);
}

}  // namespace
}  // namespace weft::simulator
