// SPDX-License-Identifier: Apache-2.0
#include "core/rig/cloth_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace weft {
namespace {

constexpr double kHeight_mm = 3;
constexpr ClothPose kPose = {20, 30};

// The point of a tilted plane, in the rig frame, that is (x, y) on the cloth.
Vec3 on_cloth(double x, double y) {
  const Vec3 centre = {0, 0, kHeight_mm};
  return centre + rig_from_cloth(kPose) * Vec3{x, y, 0};
}

TEST(ClothPose, FallsToItsAzimuthByItsTilt) {
  const Vec3 normal = rig_from_cloth(kPose) * Vec3{0, 0, 1};
  EXPECT_NEAR(degrees(std::acos(normal.z)), 20, 1e-12);
  EXPECT_NEAR(degrees(std::atan2(normal.y, normal.x)), 30, 1e-12);
  // 10 mm downhill are 10 tan 20 lower over the table.
  const double u = std::cos(radians(30)), v = std::sin(radians(30));
  const double down = 10 / std::cos(radians(20));
  const Vec3 below = on_cloth(down * u, down * v);
  EXPECT_NEAR(below.x, 10 * u, 1e-12);
  EXPECT_NEAR(below.y, 10 * v, 1e-12);
  EXPECT_NEAR(below.z, kHeight_mm - 10 * std::tan(radians(20)), 1e-12);
}

TEST(ClothPose, LeavesARigOverLevelClothAsItIs) {
  const CameraModel camera = overhead_camera({64, 48}, 600, 0.1);
  EXPECT_EQ(seen_from({}, kHeight_mm, camera), camera);
  EXPECT_EQ(seen_from({0, 70}, kHeight_mm, Vec3{1, 2, 3}).x, 1);
}

TEST(ClothPose, ShowsEachPointOfTheClothAtItsPixel) {
  const CameraModel camera = overhead_camera({64, 48}, 600, 0.1);
  const CameraModel seen = seen_from(kPose, kHeight_mm, camera);
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {2.0, -1.5}, {-3.0, 2.0}}) {
    const Vec3 pixel = project(camera, on_cloth(x, y));
    const Vec3 point = point_on_plane(seen, pixel.x, pixel.y, kHeight_mm);
    EXPECT_NEAR(point.x, x, 1e-9);
    EXPECT_NEAR(point.y, y, 1e-9);
  }
}

TEST(ClothPose, KeepsDistancesAndAnglesOfLights) {
  const NearLights rig = {.leds = {{.position_mm = {300, -200, 450}, .aim = normalized({-3, 2, -4})}},
                          .log_gain_rgb = {}};
  const NearLights seen = std::get<NearLights>(seen_from(kPose, kHeight_mm, Lights(rig)));
  const Vec3 to_led = rig.leds[0].position_mm - on_cloth(5, 7);
  const Vec3 to_seen = seen.leds[0].position_mm - Vec3{5, 7, kHeight_mm};
  EXPECT_NEAR(length(to_seen), length(to_led), 1e-9);
  EXPECT_NEAR(dot(to_seen, seen.leds[0].aim), dot(to_led, rig.leds[0].aim), 1e-9);
  EXPECT_NEAR(to_seen.z, dot(to_led, rig_from_cloth(kPose) * Vec3{0, 0, 1}), 1e-9);
  const DistantLights far = {{{.direction = {0, 0, 1}}}};
  const Vec3 direction =
      std::get<DistantLights>(seen_from(kPose, kHeight_mm, Lights(far))).lights[0].direction;
  EXPECT_NEAR(direction.z, std::cos(radians(20)), 1e-12);
}

TEST(ClothPose, TurnsTheCovarianceOfPlacesAndLeavesOtherNumbers) {
  // LED 1 is open along the cloth's normal alone, by 4 mm2, together with its brightness.
  const Vec3 n = rig_from_cloth(kPose) * Vec3{0, 0, 1};
  const std::array<double, 4> open = {2 * n.x, 2 * n.y, 2 * n.z, 0.1};
  ParameterCovariance covariance = {
      .parameters = {"led01.position_mm.x", "led01.position_mm.y", "led01.position_mm.z", "led01.log_flux"},
      .matrix = {}};
  for (const double a : open) {
    for (const double b : open) covariance.matrix.push_back(a * b);
  }
  const ParameterCovariance seen = seen_from(kPose, covariance);
  EXPECT_EQ(seen.parameters, covariance.parameters);
  const std::array<double, 4> expected = {0, 0, 2, 0.1};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(seen.matrix[4 * i + j], expected[i] * expected[j], 1e-12) << i << ", " << j;
  }
}

}  // namespace
}  // namespace weft
