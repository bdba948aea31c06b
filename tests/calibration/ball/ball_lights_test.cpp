// SPDX-License-Identifier: Apache-2.0
#include "calibration/ball/ball_lights.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"

namespace weft::calibration {
namespace {

using simulator::BallSettings;
using simulator::BallSurface;
using testing::HasSubstr;

constexpr double kCamera_mm = 600, kPixel_mm = 0.5;
constexpr int kWidth = 320, kHeight = 240;

// A twill under ten lamps, and a ball beside the middle.
simulator::Scene table(std::vector<BallSettings> balls) {
  simulator::Scene scene;
  scene.camera.width = kWidth;
  scene.camera.height = kHeight;
  scene.camera.mm_per_pixel = kPixel_mm;
  scene.camera.distance_mm = kCamera_mm;
  scene.geometry.kind = simulator::GeometryKind::kTwill;
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 3;
  scene.balls = std::move(balls);
  return scene;
}

BallSettings ball_of(BallSurface surface, double x_mm = 20, double y_mm = -12, double radius_mm = 28) {
  BallSettings ball;
  ball.surface = surface;
  ball.centre_mm = {x_mm, y_mm, radius_mm + 5};
  ball.radius_mm = radius_mm;
  ball.highlight_deg = 2;
  if (surface == BallSurface::kMatt) ball.albedo = 0.8;
  return ball;
}

// Photographs with normal noise in units of full scale; white paper under the brightest lamp has `white`.
BallPhotographs photographed(const simulator::Scene& scene, double noise, double white = 0.9) {
  const Size size = {scene.camera.width, scene.camera.height};
  const auto rendering = simulator::render_readings(scene, {0, 0, size.width, size.height});
  EXPECT_TRUE(rendering) << rendering.error().message();
  const auto rig = simulator::rig_of(scene);
  const DistantLights lights = simulator::distant_lights(*rig, scene.geometry.cloth_height_mm);
  double brightest = 0;
  for (const DistantLight& light : lights.lights) brightest = std::max(brightest, light.irradiance_rgb[1]);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  BallPhotographs photographs;
  for (std::size_t k = 0; k < lights.lights.size(); ++k) {
    Image<float> shot(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double value = rendering->readings(x, y, static_cast<int>(3 * k + 1)) * white / brightest;
        shot(x, y) = static_cast<float>(std::clamp(value + noise * normal(random), 0.0, 1.0));
      }
    }
    photographs.shots.push_back(std::move(shot));
    photographs.names.push_back(fmt::format("{:02}.tif", k + 1));
  }
  return photographs;
}

std::vector<Vec3> true_directions(const simulator::Scene& scene) {
  std::vector<Vec3> directions;
  for (const DistantLight& light :
       simulator::distant_lights(*simulator::rig_of(scene), scene.geometry.cloth_height_mm).lights)
    directions.push_back(light.direction);
  return directions;
}

double fov_deg(int width = kWidth) {
  return degrees(2 * std::atan(width * kPixel_mm / 2 / kCamera_mm));
}

double worst_angle_deg(const BallLights& lights, const std::vector<Vec3>& truth) {
  double worst = 0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    worst = std::max(worst, angle_deg(lights.lamps[k].direction, truth[k]));
  return worst;
}

std::string said_of(const Result<BallLights>& lights) {
  return lights ? "lights" : lights.error().message();
}

TEST(BallLights, OfAMirrorAreWithinAThirdOfADegree) {
  for (const BallSurface surface : {BallSurface::kChrome, BallSurface::kGlossy}) {
    const simulator::Scene scene = table({ball_of(surface)});
    const auto lights = lights_of_balls(photographed(scene, 0.002), {.fov_deg = fov_deg()});
    ASSERT_TRUE(lights) << said_of(lights);
    ASSERT_EQ(lights->balls.size(), 1U);
    EXPECT_EQ(lights->balls[0].kind, BallKind::kMirror);
    ASSERT_EQ(lights->lamps.size(), 10U);
    EXPECT_LT(worst_angle_deg(*lights, true_directions(scene)), 0.3) << static_cast<int>(surface);
    EXPECT_FALSE(lights->lamps[0].strength) << "nobody said what mirrors";
  }
}

TEST(BallLights, OfAMattBallAreWithinHalfADegreeAndHaveStrengths) {
  const simulator::Scene scene = table({ball_of(BallSurface::kMatt)});
  const auto lights = lights_of_balls(photographed(scene, 0.002), {.fov_deg = fov_deg()});
  ASSERT_TRUE(lights) << said_of(lights);
  ASSERT_EQ(lights->balls.size(), 1U);
  EXPECT_EQ(lights->balls[0].kind, BallKind::kMatt);
  EXPECT_LT(worst_angle_deg(*lights, true_directions(scene)), 0.5);
  const auto truth = simulator::distant_lights(*simulator::rig_of(scene), 0).lights;
  double mean = 0;
  for (const DistantLight& light : truth) mean += light.irradiance_rgb[1] / 10;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    ASSERT_TRUE(lights->lamps[k].strength);
    EXPECT_NEAR(*lights->lamps[k].strength, truth[k].irradiance_rgb[1] / mean, 0.01) << k;
  }
}

TEST(BallLights, AreWorseByWhereTheBallLiesWithoutAFieldOfView) {
  const simulator::Scene scene = table({ball_of(BallSurface::kChrome, 40, 0)});
  const BallPhotographs photographs = photographed(scene, 0.002);
  const auto lights = lights_of_balls(photographs, {});
  ASSERT_TRUE(lights) << said_of(lights);
  // The camera sees the ball this far beside its axis, and its rim under half this angle to its centre.
  const double beside_deg = degrees(std::atan(40.0 / (kCamera_mm - 33))), rim_deg = degrees(28.0 / 567);
  EXPECT_GT(worst_angle_deg(*lights, true_directions(scene)), beside_deg);
  EXPECT_LT(worst_angle_deg(*lights, true_directions(scene)), beside_deg + rim_deg);
}

TEST(BallLights, OfTwoBallsHavePositionsWithinTwoPercent) {
  simulator::Scene scene =
      table({ball_of(BallSurface::kChrome, -110, -14, 34), ball_of(BallSurface::kChrome, 109, 16, 34)});
  scene.effects.near_light = true;
  for (BallSettings& ball : scene.balls) ball.highlight_deg = 3;
  scene.camera.width = 640;
  const auto lights = lights_of_balls(photographed(scene, 0.002), {.ball_mm = 68, .fov_deg = fov_deg(640)});
  ASSERT_TRUE(lights) << said_of(lights);
  ASSERT_EQ(lights->balls.size(), 2U);
  const auto leds = simulator::rig_of(scene)->leds.leds;
  for (std::size_t k = 0; k < leds.size(); ++k) {
    ASSERT_TRUE(lights->lamps[k].position_mm) << k;
    const Vec3 truth = leds[k].position_mm - Vec3{0, 0, 39};
    const double off = length(*lights->lamps[k].position_mm - truth);
    EXPECT_LT(off, 0.02 * length(truth)) << k;
    EXPECT_LT(off, 4 * lights->lamps[k].position_sigma_mm) << k;
  }
}

TEST(BallLights, OfAChromeBallHaveStrengthsWhereNothingIsClipped) {
  simulator::Scene scene = table({ball_of(BallSurface::kChrome)});
  const BallOptions options = {.kind = BallKind::kChrome, .fov_deg = fov_deg()};
  const auto clipped = lights_of_balls(photographed(scene, 0.002), options);
  ASSERT_TRUE(clipped) << said_of(clipped);
  EXPECT_FALSE(clipped->lamps[0].strength) << "a highlight at full scale";
  scene.balls[0].highlight_deg = 4;
  const auto lights = lights_of_balls(photographed(scene, 0.0002, 0.005), options);
  ASSERT_TRUE(lights) << said_of(lights);
  const auto truth = simulator::distant_lights(*simulator::rig_of(scene), 0).lights;
  double mean = 0;
  for (const DistantLight& light : truth) mean += light.irradiance_rgb[1] / 10;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    ASSERT_TRUE(lights->lamps[k].strength) << k;
    EXPECT_NEAR(*lights->lamps[k].strength, truth[k].irradiance_rgb[1] / mean, 0.03) << k;
  }
}

TEST(BallLights, AreToldOfABallThatIsNamed) {
  const simulator::Scene scene = table({ball_of(BallSurface::kChrome)});
  const BallPhotographs photographs = photographed(scene, 0.002);
  const auto found = lights_of_balls(photographs, {.fov_deg = fov_deg()});
  ASSERT_TRUE(found) << said_of(found);
  Circle about = found->balls[0].outline.circle;
  about = {about.x + 3, about.y - 2, about.radius - 2};
  const auto lights = lights_of_balls(photographs, {.told = {about}, .fov_deg = fov_deg()});
  ASSERT_TRUE(lights) << said_of(lights);
  EXPECT_FALSE(lights->balls[0].as_told);
  EXPECT_LT(worst_angle_deg(*lights, true_directions(scene)), 0.3);
}

TEST(BallLights, AreRefusedWithoutABall) {
  EXPECT_THAT(said_of(lights_of_balls(photographed(table({}), 0.002), {})), HasSubstr("no ball is seen"));
}

TEST(BallLights, AreRefusedOfABallThatThePictureCuts) {
  const BallPhotographs photographs = photographed(table({ball_of(BallSurface::kMatt, 62, 0)}), 0.002);
  EXPECT_THAT(said_of(lights_of_balls(photographs, {})), HasSubstr("the border of the picture cuts it"));
}

TEST(BallLights, AreRefusedOfABallThatMoved) {
  for (const BallSurface surface : {BallSurface::kChrome, BallSurface::kMatt}) {
    BallPhotographs photographs = photographed(table({ball_of(surface)}), 0.002);
    BallPhotographs moved = photographed(table({ball_of(surface, 23, -10)}), 0.002);
    for (std::size_t k = 7; k < 10; ++k) photographs.shots[k] = std::move(moved.shots[k]);
    const std::string said = said_of(lights_of_balls(photographs, {}));
    EXPECT_THAT(said, HasSubstr("has moved by")) << static_cast<int>(surface);
  }
}

TEST(BallLights, AreRefusedWhereALampIsMissingOrDouble) {
  const simulator::Scene scene = table({ball_of(BallSurface::kChrome)});
  BallPhotographs photographs = photographed(scene, 0.002);
  BallPhotographs others = photographed(scene, 0.002);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      photographs.shots[3](x, y) = 0.01F;
      others.shots[3](x, y) = std::max(others.shots[3](x, y), others.shots[6](x, y));
    }
  }
  EXPECT_THAT(said_of(lights_of_balls(photographs, {})),
              testing::AllOf(HasSubstr("04.tif"), HasSubstr("no ball has a highlight")));
  EXPECT_THAT(said_of(lights_of_balls(others, {})),
              testing::AllOf(HasSubstr("04.tif"), HasSubstr("two lamps are lit")));
}

TEST(BallLights, PassOverWhatTheRoomLeavesInAllShots) {
  const simulator::Scene scene = table({ball_of(BallSurface::kChrome)});
  BallPhotographs photographs = photographed(scene, 0.002);
  const auto clean = lights_of_balls(photographs, {.fov_deg = fov_deg()});
  ASSERT_TRUE(clean) << said_of(clean);
  const Circle ball = clean->balls[0].outline.circle;
  for (Image<float>& shot : photographs.shots) {
    for (int y = -4; y < 5; ++y) {
      for (int x = -4; x < 5; ++x)
        shot(static_cast<int>(ball.x) + x - 20, static_cast<int>(ball.y) + y + 18) = 1;
    }
  }
  const auto lights = lights_of_balls(photographs, {.fov_deg = fov_deg()});
  ASSERT_TRUE(lights) << said_of(lights);
  EXPECT_LT(worst_angle_deg(*lights, true_directions(scene)), 0.3);
}

}  // namespace
}  // namespace weft::calibration
