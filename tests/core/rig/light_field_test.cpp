// SPDX-License-Identifier: Apache-2.0
#include "core/rig/light_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/core/child.h"

namespace weft {
namespace {

using testing::HasSubstr;

// The centre (320, 240) and the corners are points of the grid, where nothing is interpolated.
constexpr Size kSize = {641, 481};
const CameraModel kCamera = overhead_camera(kSize, 600, 0.3);

NearLights leds_at(const std::vector<Vec3>& positions_mm) {
  NearLights lights;
  for (const Vec3& p : positions_mm) lights.leds.push_back({.position_mm = p, .aim = normalized(-1.0 * p)});
  return lights;
}

NearLights ring(int count, double radius_mm = 300, double height_mm = 500) {
  std::vector<Vec3> positions;
  for (int k = 0; k < count; ++k) {
    const double azimuth = 2 * kPi * k / count + 0.2;
    positions.push_back({radius_mm * std::cos(azimuth), radius_mm * std::sin(azimuth), height_mm});
  }
  return leds_at(positions);
}

// Unit directions at one zenith angle: their condition number is sqrt(2) / tan(zenith) up to 54.7 degrees and
// its inverse beyond.
std::vector<Vec3> cone(int count, double tan_zenith) {
  std::vector<Vec3> directions;
  for (int k = 0; k < count; ++k) {
    const double azimuth = 2 * kPi * k / count + 0.2;
    directions.push_back(normalized({tan_zenith * std::cos(azimuth), tan_zenith * std::sin(azimuth), 1}));
  }
  return directions;
}

std::string why(const Result<LightField>& field) {
  return field ? "works" : field.error().message();
}

TEST(LightField, HasTheClosedFormOfANearLedWithItsLobeAndGain) {
  NearLights lights = ring(4);
  NearLight& led = lights.leds[1];
  led.aim = normalized({0.1, -0.5, -0.9});
  led.mu = 2.5;
  led.flux_rgb = {1.1e5, 2.2e5, 3.3e5};
  led.log_gain_quadratic = {0.1, -0.2, 0.3, -0.05, 0.15, 0.07};
  lights.log_gain_rgb[0] = {4, 4, std::vector<double>(16, 0.4)};
  lights.log_gain_rgb[2] = {4, 4, std::vector<double>(16, -0.3)};
  const double height_mm = 3;
  const Result<LightField> field = LightField::make(lights, kCamera, kSize, height_mm);
  ASSERT_TRUE(field) << field.error().message();
  EXPECT_EQ(field->count(), 4U);
  EXPECT_EQ(field->cloth_height_mm(), height_mm);
  EXPECT_TRUE(field->has_gain());

  const double mm_per_pixel = 0.3 * (600 - height_mm) / 600;
  const std::array<double, 3> shared = {0.4, 0, -0.3};
  for (const auto& [x, y] :
       {std::pair(320, 240), std::pair(0, 0), std::pair(640, 0), std::pair(0, 480), std::pair(640, 480)}) {
    const Vec3 to_led = led.position_mm - Vec3{mm_per_pixel * (x - 320), mm_per_pixel * (240 - y), height_mm};
    const double d = length(to_led), u = (x - 320) / 320.0, v = (y - 240) / 240.0;
    const double lobe = std::pow(-dot(to_led, led.aim) / d, 2.5);
    const double own = 0.1 - 0.2 * u + 0.3 * v - 0.05 * u * u + 0.15 * u * v + 0.07 * v * v;
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const double strength = led.flux_rgb[channel] * std::exp(shared[channel] + own) * lobe / (d * d);
      const LightField::Light light = field->at(1, c, x, y);
      EXPECT_LT(angle_deg(light.direction, to_led), 1e-12) << "degrees at (" << x << ", " << y << ")";
      EXPECT_NEAR(length(light.direction), 1, 1e-14);
      EXPECT_NEAR(light.strength / strength, 1, 1e-12) << "channel " << c << " at (" << x << ", " << y << ")";
    }
  }
}

TEST(LightField, GivesNothingBehindTheLed) {
  NearLights lights = ring(5);
  lights.leds[2].aim = {0, 0, 1};
  const Result<LightField> field = LightField::make(lights, kCamera, kSize, 0);
  ASSERT_TRUE(field) << field.error().message();
  EXPECT_EQ(field->at(2, 1, 100, 100).strength, 0);
  EXPECT_GT(field->at(1, 1, 100, 100).strength, 0);
}

TEST(LightField, OfDistantLightsIsTheSameForEveryPixelAndNeedsNoCamera) {
  DistantLights lights;
  for (const Vec3& l : cone(3, 1)) lights.lights.push_back({l, {0.5, 0.6, 0.7}});
  const Result<LightField> field = LightField::make(lights, std::nullopt, kSize, 0);
  ASSERT_TRUE(field) << field.error().message();
  for (const int x : {0, 17, 640}) {
    EXPECT_EQ(field->at(2, 1, x, x / 2).direction, lights.lights[2].direction);
    EXPECT_EQ(field->at(2, 1, x, x / 2).strength, 0.6);
  }
  EXPECT_FALSE(field->has_gain());
}

TEST(LightField, RowsForTheKernelsHoldWhatEveryPixelHoldsOfAnyStretch) {
  NearLights lights = ring(4);
  lights.log_gain_rgb[1] = {4, 4, {}};
  for (int i = 0; i < 16; ++i) lights.log_gain_rgb[1].coefficients.push_back(0.05 * (i % 5) - 0.02 * i);
  lights.leds[3].log_gain_quadratic = {0, 0.1, -0.1, 0.2, 0.1, -0.2};
  const Result<LightField> field = LightField::make(lights, kCamera, kSize, 2);
  ASSERT_TRUE(field) << field.error().message();
  LightField::Row row;
  for (const auto& [x0, x1] : {std::pair(0, 641), std::pair(64, 193), std::pair(640, 641), std::pair(0, 1)}) {
    for (const int y : {0, 5, 16, 240, 479, 480}) {
      field->read_row(y, x0, x1, row);
      for (int x = x0; x < x1; ++x) {
        const auto value = [x, from = x0](const LightField::RowLine& line) {
          const auto cell = static_cast<std::size_t>((x - from) / LightField::kCell);
          return static_cast<double>(line.value.at(cell)) +
                 x % LightField::kCell * static_cast<double>(line.step.at(cell));
        };
        const Vec3 to_led = lights.leds[3].position_mm - Vec3{value(row.x_mm), value(row.y_mm), 2};
        const double d2 = dot(to_led, to_led);
        const double strength = value(row.gain_rgb[1]) * value(row.led_gain[3]) *
                                -dot(to_led, lights.leds[3].aim) / std::sqrt(d2) / d2;
        const LightField::Light light = field->at(3, 1, x, y);
        ASSERT_LT(angle_deg(light.direction, to_led), 1e-5) << "degrees at (" << x << ", " << y << ")";
        ASSERT_NEAR(strength / light.strength, 1, 1e-6) << "at (" << x << ", " << y << ")";
      }
    }
  }
}

TEST(LightField, OfTheLastPointOfTheGridBesideTheFrameIsThatOfThePoint) {
  const NearLights lights = ring(4);
  const Result<LightField> field = LightField::make(lights, kCamera, kSize, 2);
  ASSERT_TRUE(field) << field.error().message();
  for (const auto& [x, y] : {std::pair(656, 0), std::pair(0, 496), std::pair(656, 496)}) {
    const Vec3 to_led = lights.leds[2].position_mm - point_on_plane(kCamera, x, y, 2);
    const LightField::Light light = field->at(2, 1, x, y);
    EXPECT_LT(angle_deg(light.direction, to_led), 1e-5) << "degrees at (" << x << ", " << y << ")";
    EXPECT_TRUE(std::isfinite(light.strength)) << light.strength;
  }
}

TEST(LightField, OfASinglePixelOrLineWithGainIsFinite) {
  for (const Size size : {Size{1, 1}, Size{1, 100}, Size{100, 1}}) {
    const std::string said = said_by_child([&] {
      NearLights lights = ring(4);
      lights.log_gain_rgb[1] = {4, 4, std::vector<double>(16, 0.5)};
      const Result<LightField> field = LightField::make(lights, overhead_camera(size, 600, 0.3), size, 0);
      if (!field) return field.error().message();
      return std::string(std::isfinite(field->at(0, 1, 0, 0).strength) ? "finite" : "not finite");
    });
    EXPECT_EQ(said, "finite") << size.width << " x " << size.height;
  }
}

TEST(LightField, NeedsThreeLights) {
  EXPECT_THAT(why(LightField::make(ring(2), kCamera, kSize, 0)), HasSubstr("give at least three lights"));
  EXPECT_THAT(why(LightField::make(NearLights(), kCamera, kSize, 0)), HasSubstr("0 lights"));
  EXPECT_THAT(why(LightField::make(DistantLights(), std::nullopt, kSize, 0)), HasSubstr("0 lights"));
  EXPECT_EQ(why(LightField::make(ring(3), kCamera, kSize, 0)), "works");
}

TEST(LightField, NeedsACameraForNearLights) {
  EXPECT_THAT(why(LightField::make(ring(4), std::nullopt, kSize, 0)),
              HasSubstr("calibrate the camera first"));
}

TEST(LightField, RefusesALedAtOrBelowTheCloth) {
  for (const double led_mm : {-200.0, 0.0, 20.0}) {
    NearLights lights = ring(4);
    lights.leds[2].position_mm.z = led_mm;
    const Result<LightField> field = LightField::make(lights, kCamera, kSize, 20);
    ASSERT_FALSE(field) << led_mm;
    EXPECT_EQ(field.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(field.error().where, "LED 3");
    EXPECT_THAT(field.error().why, HasSubstr("the cloth 20.0 mm"));
  }
}

TEST(LightField, TakesLedsOfOneHeight) {
  for (const int count : {3, 4, 10}) {
    EXPECT_EQ(why(LightField::make(ring(count), kCamera, kSize, 0)), "works") << count << " LEDs";
  }
}

TEST(LightField, RefusesLedsInOnePlaneWithTheClothPointWherePhotographsWouldMissANormal) {
  const Result<LightField> centre = LightField::make(
      leds_at({{-300, 0, 400}, {10, 0, 500}, {250, 0, 300}, {90, 0, 600}}), kCamera, kSize, 0);
  ASSERT_FALSE(centre);
  EXPECT_EQ(centre.error().kind, ErrorKind::kBadData);
  EXPECT_EQ(centre.error().where, "centre of the frame");
  // The corners see (-96, 72), (96, 72), (-96, -72) and (96, -72) mm of the table.
  const Result<LightField> top =
      LightField::make(leds_at({{-300, 72, 400}, {0, 72, 500}, {250, 72, 300}}), kCamera, kSize, 0);
  ASSERT_FALSE(top);
  EXPECT_EQ(top.error().where, "top left corner of the frame");
  const Result<LightField> right =
      LightField::make(leds_at({{96, 0, 400}, {96, 100, 500}, {96, -90, 300}}), kCamera, kSize, 0);
  ASSERT_FALSE(right);
  EXPECT_EQ(right.error().where, "top right corner of the frame");
  // The plane through the bottom left corner that rises to the right holds no other corner.
  const auto rising = [](double x, double y) { return Vec3{x, y, (x + 96) + 0.5 * (y + 72)}; };
  const Result<LightField> corner =
      LightField::make(leds_at({rising(300, 50), rising(200, -150), rising(250, 250)}), kCamera, kSize, 0);
  ASSERT_FALSE(corner);
  EXPECT_EQ(corner.error().where, "bottom left corner of the frame");
}

TEST(LightField, CountsOnlyLightsThatReachThePixel) {
  NearLights lights = ring(3);
  lights.leds[0].aim = {0, 0, 1};
  EXPECT_THAT(why(LightField::make(lights, kCamera, kSize, 0)), HasSubstr("the directions of 2 lights"));
}

TEST(LightField, RefusesDistantLightsFromAConditionNumberOfAMillion) {
  const auto with_condition = [](double condition) {
    DistantLights lights;
    for (const Vec3& l : cone(5, std::sqrt(2.0) / condition)) lights.lights.push_back({l, {1, 1, 1}});
    return why(LightField::make(lights, std::nullopt, kSize, 0));
  };
  EXPECT_EQ(with_condition(0.99e6), "works");
  EXPECT_THAT(with_condition(1.01e6), HasSubstr("have condition number 1.01e+06"));
}

TEST(LightField, RefusesACameraThatDoesNotSeeTheTable) {
  CameraModel up = kCamera;
  up.camera_from_rig_rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  up.camera_from_rig_translation_mm = {0, 0, -600};
  EXPECT_THAT(why(LightField::make(ring(4), up, kSize, 0)), HasSubstr("does not look at the table"));
  CameraModel sideways = kCamera;
  sideways.camera_from_rig_rotation = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
  sideways.camera_from_rig_translation_mm = {0, 600, 0};
  EXPECT_THAT(why(LightField::make(ring(4), sideways, kSize, 0)), HasSubstr("does not look at the table"));
}

TEST(LightField, RefusesALensThatShowsTheCornersNoPoint) {
  CameraModel camera = overhead_camera(kSize, 200, 0.5);
  camera.k1 = -0.9;
  EXPECT_THAT(why(LightField::make(ring(4), camera, kSize, 0)), HasSubstr("does not look at the table"));
}

TEST(ConditionNumber, OfKnownSets) {
  EXPECT_NEAR(condition_number({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 1, 1e-14);
  EXPECT_NEAR(condition_number({{2, 0, 0}, {0, 1, 0}, {0, 0, 0.5}}), 4, 1e-13);
  for (const int count : {3, 4, 10}) {
    for (const double tan_zenith : {0.01, 0.5, 1.0}) {
      EXPECT_NEAR(condition_number(cone(count, tan_zenith)) * tan_zenith / std::sqrt(2), 1, 1e-10);
    }
    EXPECT_NEAR(condition_number(cone(count, 3)), 3 / std::sqrt(2), 1e-12);
  }
}

// The same directions turned at random: no axis is special.
TEST(ConditionNumber, IsGoodToAThousandthNearAMillion) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Vec3 z = normalized({normal(random), normal(random), normal(random)});
    const Vec3 x = normalized(cross(z, {normal(random), normal(random), normal(random)})), y = cross(z, x);
    std::vector<Vec3> directions;
    for (const Vec3& l : cone(3 + i % 10, std::sqrt(2) * 1e-6))
      directions.push_back(l.x * x + l.y * y + l.z * z);
    EXPECT_NEAR(condition_number(directions) / 1e6, 1, 1e-3) << directions.size() << " lights";
  }
}

TEST(ConditionNumber, IsInfiniteForDirectionsInOnePlane) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(condition_number({}), kInfinity);
  EXPECT_EQ(condition_number({{0, 0, 1}}), kInfinity);
  EXPECT_EQ(condition_number({{0, 0, 1}, {0, 1, 0}}), kInfinity);
  EXPECT_EQ(condition_number({{0, 0, 1}, {0, 0.6, 0.8}, {0, -0.6, 0.8}, {0, 1, 0}}), kInfinity);
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x = normalized({normal(random), normal(random), normal(random)});
    const Vec3 y = normalized(cross(x, {normal(random), normal(random), normal(random)}));
    std::vector<Vec3> directions;
    for (int k = 0; k < 3 + i % 20; ++k) {
      const double angle = normal(random);
      directions.push_back(std::cos(angle) * x + std::sin(angle) * y);
    }
    EXPECT_EQ(condition_number(directions), kInfinity) << directions.size() << " lights";
  }
}

}  // namespace
}  // namespace weft
