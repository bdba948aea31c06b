// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/scene_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/sampling/random.h"
#include "tests/simulator/camera/frame.h"

namespace weft::simulator {
namespace {

using testing::HasSubstr;

constexpr double kDistance_mm = 600, kMmPerPixel = 0.08;

CameraModel camera_with(const LensSettings& lens, const PoseSettings& pose = {},
                        double mm_per_pixel = kMmPerPixel) {
  Result<CameraModel> camera = camera_of(kFrame, kDistance_mm, mm_per_pixel, lens, pose, 0);
  if (camera) return *camera;
  ADD_FAILURE() << camera.error().message();
  return {};
}

/// The largest distance in pixels between a pixel of the frame and where the point that it sees is seen.
double largest_round_trip(const CameraModel& camera) {
  Result<Lens> lens = Lens::of(camera);
  if (!lens) {
    ADD_FAILURE() << lens.error().message();
    return 1e9;
  }
  double largest = 0;
  constexpr int kSteps = 40;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const double x = (camera.size.width - 1.0) * i / kSteps, y = (camera.size.height - 1.0) * j / kSteps;
      const auto back = lens->picture_point(lens->point_on_plane(x, y, 0));
      largest = std::max(largest, back ? std::hypot(back->x_px - x, back->y_px - y) : 1e9);
    }
  return largest;
}

TEST(Lens, SeesWhatTheCameraStraightAboveSeesInClosedForm) {
  const CameraModel camera = camera_with({});
  EXPECT_EQ(camera, overhead_camera(kFrame, kDistance_mm, kMmPerPixel));
  for (const auto& row : camera.camera_from_rig_rotation)
    for (const double m : row) EXPECT_FALSE(m == 0 && std::signbit(m)) << "files would hold -0";
  const Lens lens = *Lens::of(camera);
  for (const int x : {0, 1, 1000, 2463})
    for (const int y : {0, 815, 1631}) {
      const Vec3 point = lens.point_on_plane(x, y, 30);
      EXPECT_NEAR(point.x, (x - 1231.5) * 0.08 * 570 / 600, 1e-12);
      EXPECT_NEAR(point.y, (815.5 - y) * 0.08 * 570 / 600, 1e-12);
      EXPECT_EQ(point.z, 30);
    }
}

TEST(Lens, FindsEachPixelAgainThroughStrongDistortion) {
  // 41 degrees to the corner, where distortion counts.
  const LensSettings lenses[] = {
      {},
      {.k1 = -0.15},
      {.k1 = -0.28, .k2 = 0.11, .k3 = -0.018},
      {.k1 = 0.6, .k2 = 0.4, .k3 = 0.3},
      {.k1 = -0.2, .k2 = 0.05, .p1 = 0.02, .p2 = -0.03, .offset_x_px = 100, .offset_y_px = -60},
      {.k1 = 2, .k2 = 3, .k3 = 4, .p1 = 0.01},
  };
  for (const LensSettings& lens : lenses)
    for (const PoseSettings& pose : {PoseSettings{}, PoseSettings{20, 40, 10, 5, -7}})
      EXPECT_LT(largest_round_trip(camera_with(lens, pose, 0.35)), 1e-8)
          << "k1 = " << lens.k1 << ", tilt " << pose.tilt_deg;
}

TEST(Lens, FindsEachPixelAgainThroughAnyLensItAccepts) {
  int accepted = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const NormalPair k = normal_pair(philox({i, 0, 0, 0}, {7, 7}));
    const NormalPair q = normal_pair(philox({i, 1, 0, 0}, {7, 7}));
    const NormalPair more = normal_pair(philox({i, 2, 0, 0}, {7, 7}));
    CameraModel camera = overhead_camera({300, 200}, 600, 4);  // 33 degrees to the side
    camera.k1 = 0.5 * k.first, camera.k2 = 0.5 * k.second, camera.k3 = 0.3 * more.first;
    camera.p1 = 0.03 * q.first, camera.p2 = 0.03 * q.second;
    if (!Lens::of(camera)) continue;
    ++accepted;
    EXPECT_LT(largest_round_trip(camera), 1e-9) << "lens " << i;
  }
  EXPECT_GT(accepted, 100);
}

TEST(Lens, AgreesWithTheModelThatCalibrationsHold) {
  const CameraModel camera =
      camera_with({.k1 = -0.2, .k2 = 0.1, .k3 = -0.05, .p1 = 0.004, .p2 = -0.003}, {15, 130, -20, 3, 4});
  const Lens lens = *Lens::of(camera);
  for (const double x : {0.0, 700.25, 2463.0})
    for (const double y : {0.0, 333.5, 1631.0}) {
      const Vec3 ours = lens.point_on_plane(x, y, 2), cores = point_on_plane(camera, x, y, 2);
      EXPECT_LT(length(ours - cores), 1e-8);
      const CameraRay ray = lens.ray(x, y);
      EXPECT_NEAR(length(ray.direction), 1, 1e-15);
      EXPECT_LT(length(cross(ours - ray.origin_mm, ray.direction)), 1e-9) << "the ray passes the point";
      const Vec3 seen = project(camera, ours);
      const auto point = lens.picture_point(ours);
      ASSERT_TRUE(point.has_value());
      EXPECT_NEAR(point->x_px, seen.x, 1e-9);
      EXPECT_NEAR(point->y_px, seen.y, 1e-9);
      EXPECT_NEAR(point->depth_mm, seen.z, 1e-9);
    }
}

TEST(Lens, GivesFiniteRaysFarBesideTheFrame) {
  const Lens lens = *Lens::of(camera_with({.k1 = -0.25, .k2 = 0.05, .p1 = 0.01}, {}, 0.4));
  for (const double x : {-1e5, -500.0, 3000.0, 1e7}) {
    const Vec3 d = lens.ray(x, -x).direction;
    EXPECT_NEAR(length(d), 1, 1e-14) << "at " << x;
  }
}

TEST(Lens, DoesNotShowWhatItSeesBehindItOrMightFoldIn) {
  const Lens lens = *Lens::of(camera_with({.k1 = -0.2}));
  EXPECT_TRUE(lens.picture_point({0, 0, 0}).has_value());
  EXPECT_FALSE(lens.picture_point({0, 0, 700}).has_value()) << "behind";
  EXPECT_FALSE(lens.picture_point({0, 0, 600}).has_value()) << "in the lens";
  // r (1 - 0.2 r^2) is 0 at r = sqrt(5): polynomial and picture part.
  EXPECT_FALSE(lens.picture_point({600 * std::sqrt(5.0), 0, 0}).has_value());
}

TEST(Lens, RefusesAPictureThatFolds) {
  // r - 0.5 r^3 turns back at r = 0.816, at 0.544 of a focal length; the corner is at 1.0 with 0.4 mm a
  // pixel.
  for (const LensSettings& lens :
       {LensSettings{.k1 = -0.5}, LensSettings{.k2 = -2}, LensSettings{.k3 = -10}, LensSettings{.p1 = 0.5}}) {
    const auto camera = camera_of(kFrame, kDistance_mm, 0.4, lens, {}, 0);
    ASSERT_FALSE(camera.has_value()) << "k1 = " << lens.k1;
    EXPECT_EQ(camera.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(camera.error().message(), HasSubstr("the lens folds the picture"));
  }
  EXPECT_TRUE(camera_of(kFrame, kDistance_mm, 0.1, {.k1 = -0.5}, {}, 0).has_value()) << "corner at 0.25";
}

TEST(CameraOf, LooksAtItsPointFromItsDistance) {
  for (const double azimuth_deg : {0.0, 90.0, -135.0}) {
    const PoseSettings pose = {30, azimuth_deg, 25, 12, -8};
    const CameraModel camera = camera_with({}, pose);
    const Lens lens = *Lens::of(camera);
    const auto centre = lens.picture_point({12, -8, 0});
    ASSERT_TRUE(centre.has_value());
    EXPECT_NEAR(centre->x_px, (kFrame.width - 1) / 2.0, 1e-9);
    EXPECT_NEAR(centre->y_px, (kFrame.height - 1) / 2.0, 1e-9);
    EXPECT_NEAR(centre->depth_mm, kDistance_mm, 1e-9);
    const Vec3 from = lens.ray(0, 0).origin_mm - Vec3{12, -8, 0};
    const double a = radians(azimuth_deg);
    EXPECT_LT(length(from - kDistance_mm * Vec3{0.5 * std::cos(a), 0.5 * std::sin(a), std::sqrt(0.75)}),
              1e-9);
    const Mat3& r = camera.camera_from_rig_rotation;
    const Vec3 x = {r[0][0], r[0][1], r[0][2]}, y = {r[1][0], r[1][1], r[1][2]};
    EXPECT_LT(length(cross(x, y) - Vec3{r[2][0], r[2][1], r[2][2]}), 1e-15) << "a rotation";
    EXPECT_NEAR(dot(x, x), 1, 1e-15);
  }
}

TEST(CameraOf, StaysUprightWhereItDoesNotRoll) {
  const Lens upright = *Lens::of(camera_with({}, {.azimuth_deg = 77}));
  EXPECT_NEAR(upright.picture_point({1, 0, 0})->x_px, 1231.5 + 12.5, 1e-9);
  const Lens rolled = *Lens::of(camera_with({}, {.roll_deg = 90}));
  const auto x_axis = rolled.picture_point({1, 0, 0});
  EXPECT_NEAR(x_axis->x_px, 1231.5, 1e-9);
  EXPECT_NEAR(x_axis->y_px, 815.5 - 12.5, 1e-9) << "a camera turned clockwise sees x turned up";
}

TEST(CameraOf, RefusesACameraThatDoesNotSeeTheTable) {
  struct Case {
    PoseSettings pose;
    double height_mm;
  };
  for (const Case& c :
       {Case{{.tilt_deg = 80}, 0}, Case{{}, 600}, Case{{}, 700}, Case{{.tilt_deg = 60}, 400}}) {
    const auto camera = camera_of(kFrame, kDistance_mm, 0.2, {}, c.pose, c.height_mm);
    ASSERT_FALSE(camera.has_value()) << c.pose.tilt_deg << ", " << c.height_mm;
    EXPECT_EQ(camera.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(camera.error().message(), HasSubstr("does not see the table"));
  }
  EXPECT_TRUE(camera_of(kFrame, kDistance_mm, 0.2, {}, {.tilt_deg = 60}, 0).has_value());
}

}  // namespace
}  // namespace weft::simulator
