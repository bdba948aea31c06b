// SPDX-License-Identifier: Apache-2.0
#include "core/rig/camera.h"

#include <gtest/gtest.h>

#include "core/rig/light_field.h"

namespace weft {
namespace {

constexpr Size kSensor = {4928, 3264};

// Turns `overhead` about the rig's x axis, then y, the table's centre staying where it is seen.
CameraModel tilted(CameraModel overhead, double about_x_deg, double about_y_deg) {
  const double a = radians(about_x_deg), b = radians(about_y_deg);
  const Vec3 x = {std::cos(b), 0, -std::sin(b)};
  const Vec3 y = {std::sin(a) * std::sin(b), std::cos(a), std::sin(a) * std::cos(b)};
  const Vec3 z = cross(x, y);
  overhead.camera_from_rig_rotation = {{{x.x, x.y, x.z}, {-y.x, -y.y, -y.z}, {-z.x, -z.y, -z.z}}};
  return overhead;
}

CameraModel strongly_distorted() {
  CameraModel camera = tilted(overhead_camera(kSensor, 600, 0.08), 12, -17);
  camera.fy *= 1.01;
  camera.cx += 31.5;
  camera.cy -= 17.25;
  camera.k1 = -0.3;
  camera.k2 = 0.12;
  camera.k3 = -0.02;
  camera.p1 = 0.004;
  camera.p2 = -0.003;
  return camera;
}

TEST(Camera, ProjectingAPointOnThePlaneReturnsItsPixel) {
  const CameraModel camera = strongly_distorted();
  for (const double height : {-3.0, 0.0, 12.5}) {
    for (int y = 0; y < kSensor.height; y += 251) {
      for (int x = 0; x < kSensor.width; x += 307) {
        const Vec3 pixel = project(camera, point_on_plane(camera, x, y, height));
        EXPECT_LT(std::hypot(pixel.x - x, pixel.y - y), 1e-8) << "pixels at (" << x << ", " << y << ")";
      }
    }
  }
}

TEST(Camera, ThePixelOfAPointLooksAtThatPoint) {
  const CameraModel camera = strongly_distorted();
  for (const double height : {-3.0, 0.0, 12.5}) {
    for (int y = -120; y <= 120; y += 24) {
      for (int x = -180; x <= 180; x += 20) {
        const Vec3 point = {x + 0.123, y - 0.456, height};
        const Vec3 pixel = project(camera, point);
        EXPECT_GT(pixel.z, 400);
        const Vec3 seen = point_on_plane(camera, pixel.x, pixel.y, height);
        EXPECT_LT(length(seen - point), 1e-9) << "mm at (" << x << ", " << y << ")";
      }
    }
  }
}

TEST(Camera, DistortsAsBrownAndOpenCvDo) {
  CameraModel camera = overhead_camera({100, 100}, 1, 0.001);
  camera.k1 = 0.1, camera.k2 = -0.2, camera.k3 = 0.3, camera.p1 = 0.01, camera.p2 = -0.02;
  // At normalized (0.3, 0.4) r^2 is 0.25; the rig's y points up, the picture's down.
  const Vec3 pixel = project(camera, {0.3, -0.4, 0});
  const double radial = 1 + 0.1 * 0.25 - 0.2 * 0.0625 + 0.3 * 0.015625;
  EXPECT_NEAR(pixel.x, 49.5 + 1000 * (0.3 * radial + 2 * 0.01 * 0.12 - 0.02 * (0.25 + 2 * 0.09)), 1e-10);
  EXPECT_NEAR(pixel.y, 49.5 + 1000 * (0.4 * radial + 0.01 * (0.25 + 2 * 0.16) - 2 * 0.02 * 0.12), 1e-10);
  EXPECT_NEAR(pixel.z, 1, 1e-15);
}

TEST(Camera, OverheadSeesASquareGridThatGrowsWithTheDistance) {
  const CameraModel camera = overhead_camera({641, 481}, 600, 0.3);
  for (const double height : {0.0, 60.0, -30.0}) {
    const double scale = 0.3 * (600 - height) / 600;
    for (const auto& [x, y] :
         {std::pair(0.0, 0.0), std::pair(640.0, 480.0), std::pair(320.0, 240.0), std::pair(17.25, 400.5)}) {
      const Vec3 point = point_on_plane(camera, x, y, height);
      EXPECT_NEAR(point.x, scale * (x - 320), 1e-12);
      EXPECT_NEAR(point.y, scale * (240 - y), 1e-12);
      EXPECT_EQ(point.z, height);
      EXPECT_NEAR(project(camera, point).z, 600 - height, 1e-12);
    }
  }
}

double worst_grid_error_px(const CameraModel& camera) {
  NearLights lights;
  for (const double x : {-300.0, 300.0}) {
    for (const double y : {-300.0, 300.0}) lights.leds.push_back({{x, y, 500}, {0, 0, -1}});
  }
  const Result<LightField> field = LightField::make(lights, camera, camera.size, 2);
  EXPECT_TRUE(field) << field.error().message();
  if (!field) return 1e9;
  double worst = 0;
  LightField::Row row;
  for (int y = 0; y < camera.size.height; y += 4) {
    field->read_row(y, 0, camera.size.width, row);
    for (int x = 0; x < camera.size.width; x += 12) {
      const auto cell = static_cast<std::size_t>(x / LightField::kCell);
      const auto in_cell = static_cast<float>(x % LightField::kCell);
      const Vec3 point = {static_cast<double>(row.x_mm.value[cell] + in_cell * row.x_mm.step[cell]),
                          static_cast<double>(row.y_mm.value[cell] + in_cell * row.y_mm.step[cell]), 2};
      const Vec3 pixel = project(camera, point);
      worst = std::max(worst, std::hypot(pixel.x - x, pixel.y - y));
    }
  }
  return worst;
}

TEST(Camera, GridOfTheLightFieldIsUnderAHundredthOfAPixelOff) {
  for (const double mm_per_pixel : {0.05, 0.08}) {
    CameraModel camera = tilted(overhead_camera(kSensor, 600, mm_per_pixel), 0.5, -0.5);
    camera.k1 = -0.1;
    const double worst = worst_grid_error_px(camera);
    EXPECT_LT(worst, 0.01) << mm_per_pixel << " mm a pixel";
    EXPECT_GT(worst, 0) << "the lens bends nothing";
  }
}

}  // namespace
}  // namespace weft
