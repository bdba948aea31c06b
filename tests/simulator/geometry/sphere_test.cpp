// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/sphere.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/geometry/scene_surface.h"

namespace weft::simulator {
namespace {

TEST(Sphere, EveryPointIsARadiusFromTheCentreAndFacesAwayFromIt) {
  const Sphere sphere(20, 85);
  for (double x = -19.5; x < 19.6; x += 1.3) {
    for (double y = -19.5; y < 19.6; y += 1.3) {
      if (std::hypot(x, y) >= sphere.rim_mm()) continue;
      const SurfacePoint p = sphere.at(x, y);
      const Vec3 from_centre = {x, y, p.height_mm - sphere.centre_mm()};
      ASSERT_NEAR(length(from_centre), 20, 1e-12) << x << ", " << y;
      ASSERT_LT(length(20 * p.normal - from_centre), 1e-12) << x << ", " << y;
    }
  }
}

TEST(Sphere, ShowsItsSlopesUpToTheContactAngle) {
  const Sphere sphere(20, 85);
  const double rim = 20 * std::sin(radians(85));
  EXPECT_NEAR(sphere.at(0, 0).height_mm, 20 * (1 - std::cos(radians(85))), 1e-12);
  EXPECT_NEAR(angle_deg(sphere.at(rim - 1e-9, 0).normal, {0, 0, 1}), 85, 1e-6);
  EXPECT_NEAR(sphere.at(rim - 1e-12, 0).height_mm, 0, 1e-10) << "meets the table";
  EXPECT_NEAR(sphere.steepest_slope(), std::tan(radians(85)), 1e-10);
}

TEST(Sphere, LiesOnALevelTable) {
  const SurfacePoint p = Sphere(20, 85).at(15, 15);
  EXPECT_EQ(p.height_mm, 0);
  EXPECT_EQ(p.normal, (Vec3{0, 0, 1}));
}

TEST(Cylinder, IsASphereAcrossItsAxisAndConstantAlongIt) {
  const double azimuth = radians(30), c = std::cos(azimuth), s = std::sin(azimuth);
  const Cylinder cylinder(10, 70, 30);
  const Sphere sphere(10, 70);
  for (double across = -12; across <= 12; across += 0.7) {
    const SurfacePoint section = sphere.at(across, 0);
    for (const double along : {-55.0, 0.0, 8.0}) {
      const SurfacePoint p = cylinder.at(along * c - across * s, along * s + across * c);
      ASSERT_NEAR(p.height_mm, section.height_mm, 1e-12) << across << ", " << along;
      const Vec3 turned = {-s * section.normal.x, c * section.normal.x, section.normal.z};
      ASSERT_LT(length(p.normal - turned), 1e-12) << across << ", " << along;
      ASSERT_LT(length(tangent_of(p) - Vec3{c, s, 0}), 1e-12) << "the axis";
    }
  }
}

}  // namespace
}  // namespace weft::simulator
