// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simulator/light/incidence.h"

namespace weft::simulator {
namespace {

using testing::HasSubstr;

SceneRig rig(const Scene& scene) {
  Result<SceneRig> made = rig_of(scene);
  EXPECT_TRUE(made) << made.error().message();
  return std::move(made).value();
}

/// Share of full scale that an albedo facing LED 1 at the table's centre gives in green.
double signal_facing_led(const Scene& scene, double albedo) {
  const SceneRig r = rig(scene);
  const Incidence light = incidence(r.leds.leds[0], {0, 0, scene.geometry.cloth_height_mm});
  return albedo * r.leds.leds[0].flux_rgb[1] * shading(light, light.direction) * r.exposure(scene.camera.iso);
}

TEST(Rig, HasTenLedsInTwoRingsByDefault) {
  const SceneRig r = rig(Scene());
  ASSERT_EQ(r.leds.leds.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    const NearLight& led = r.leds.leds[i];
    EXPECT_NEAR(length(led.position_mm), 600, 1e-9);
    EXPECT_NEAR(angle_deg(led.position_mm, {0, 0, 1}), i < 4 ? 35 : 62, 1e-9) << "LED " << i + 1;
    EXPECT_LT(length(led.aim + (1 / 600.0) * led.position_mm), 1e-12) << "aimed at the table's centre";
    EXPECT_EQ(led.mu, 1);
    EXPECT_NEAR(led.flux_rgb[0] / led.flux_rgb[1], 0.5, 1e-12);
    EXPECT_NEAR(led.flux_rgb[2] / led.flux_rgb[1], 0.68, 1e-12);
  }
  const auto azimuth_deg = [&](std::size_t i) {
    return degrees(std::atan2(r.leds.leds[i].position_mm.y, r.leds.leds[i].position_mm.x));
  };
  EXPECT_NEAR(azimuth_deg(0), 0, 1e-9);
  EXPECT_NEAR(azimuth_deg(1), 90, 1e-9);
  EXPECT_NEAR(azimuth_deg(4), 15, 1e-9);
  EXPECT_NEAR(azimuth_deg(5), 75, 1e-9);
}

TEST(Rig, ExposesWhiteAtNineTenthsOfFullScale) {
  Scene scene;
  EXPECT_NEAR(signal_facing_led(scene, 0.99), 0.90, 1e-4) << "exact but for whole microseconds";
  EXPECT_NEAR(rig(scene).exposure_us, 16364, 1);
  scene.geometry.cloth_height_mm = 20;
  EXPECT_NEAR(signal_facing_led(scene, 0.99), 0.90, 1e-4);
  scene.camera.iso = 800;
  EXPECT_NEAR(signal_facing_led(scene, 0.99), 0.90, 1e-3);
  scene.camera.albedo_at_full = 0.05;
  EXPECT_NEAR(signal_facing_led(scene, 0.05), 0.90, 1e-4);
  EXPECT_EQ(rig(scene).exposure_us, std::round(rig(scene).exposure_us));
}

TEST(Rig, TakesTheExposureOfTheScene) {
  Scene scene;
  scene.camera.exposure_us = 4000;
  scene.camera.iso = 200;
  EXPECT_EQ(rig(scene).exposure_us, 4000);
  EXPECT_NEAR(rig(scene).exposure(200), 0.008, 1e-15);
}

TEST(Rig, PlacesRingsFirstAndSingleLedsAfterThem) {
  Scene scene;
  scene.lights.rings = {{3, 50, 10, 400}};
  scene.lights.leds = {{{100, 0, 500}, Vec3{0, 0, -2}, 3.0, Rgb{1e7, 2e7, 3e7}}, {{0, 0, 450}, {}, {}, {}}};
  const SceneRig r = rig(scene);
  ASSERT_EQ(r.leds.leds.size(), 5U);
  EXPECT_NEAR(length(r.leds.leds[2].position_mm), 400, 1e-9);
  EXPECT_EQ(r.leds.leds[3].aim, (Vec3{0, 0, -1}));
  EXPECT_EQ(r.leds.leds[3].mu, 3);
  EXPECT_EQ(r.leds.leds[3].flux_rgb[2], 3e7);
  EXPECT_EQ(r.leds.leds[4].aim, (Vec3{0, 0, -1}));
  EXPECT_EQ(r.leds.leds[4].flux_rgb[1], scene.lights.flux);
}

TEST(Rig, IsRefusedWhereItCannotStand) {
  Scene scene;
  scene.lights.leds = {{{0, 0, 30}, {}, {}, {}}};
  scene.geometry.cloth_height_mm = 30;
  EXPECT_THAT(rig_of(scene).error().message(), HasSubstr("LED 1 is not above"));
  scene.geometry.cloth_height_mm = 0;
  scene.lights.leds[0].aim = Vec3{0, 0, 1};
  EXPECT_THAT(rig_of(scene).error().message(), HasSubstr("no LED lights"));
  scene.lights.leds[0].aim.reset();
  scene.lights.flux = 1e-9;
  EXPECT_THAT(rig_of(scene).error().message(), HasSubstr("no exposure fits"));
  scene = Scene();
  scene.lights.rings = {{200, 50, 0, 600}, {57, 60, 0, 600}};
  EXPECT_THAT(rig_of(scene).error().message(), HasSubstr("257 of at most 256"));
  scene = Scene();
  scene.camera.distance_mm = 20;
  scene.geometry.cloth_height_mm = 25;
  EXPECT_THAT(rig_of(scene).error().message(), HasSubstr("camera is not above"));
  scene = Scene();
  scene.camera.width = 3;
  EXPECT_THAT(rig_of(scene).error().message(), HasSubstr("camera.width"));
}

TEST(Rig, MapsPixelsAsTheCalibrationItWrites) {
  Scene scene;
  scene.geometry.cloth_height_mm = 12;
  const Calibration calibration = exact_calibration(scene, rig(scene));
  ASSERT_TRUE(calibration.camera);
  for (const int x : {0, 17, 2463}) {
    for (const int y : {0, 900, 1631}) {
      const Vec3 expected = point_on_plane(*calibration.camera, x, y, 12);
      EXPECT_LT(length(point_of_pixel(scene, x, y) - expected), 1e-9) << x << ", " << y;
    }
  }
  EXPECT_GT(point_of_pixel(scene, 0, 0).y, 0) << "y points up in the upright image";
  EXPECT_LT(point_of_pixel(scene, 0, 0).x, 0);
}

TEST(Rig, WritesNearLightsOnlyWhereLightIsNear) {
  Scene scene;
  scene.effects.near_light = true;
  const SceneRig r = rig(scene);
  const Calibration near = exact_calibration(scene, r);
  EXPECT_EQ(near.subject.albedo_scale, AlbedoScale::kAbsolute);
  EXPECT_EQ(std::get<NearLights>(*near.lights).leds.size(), 10U);
  scene.effects.near_light = false;
  const auto distant = std::get<DistantLights>(*exact_calibration(scene, r).lights);
  ASSERT_EQ(distant.lights.size(), 10U);
  EXPECT_NEAR(distant.lights[0].irradiance_rgb[1], 2e7 / (600.0 * 600.0), 1e-9);
  EXPECT_NEAR(angle_deg(distant.lights[9].direction, {0, 0, 1}), 62, 1e-9);
}

}  // namespace
}  // namespace weft::simulator
