// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/knit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::simulator {
namespace {

Knit knit() {
  GeometrySettings g;
  g.kind = GeometryKind::kKnit;
  return Knit(g);
}

TEST(Knit, IsSymmetricAboutTheMiddleOfAWale) {
  const Knit cloth = knit();
  for (double y = 0; y < 0.75; y += 0.0137) {
    for (double u = 0.003; u < 0.5; u += 0.0171) {
      const SurfacePoint right = cloth.at(0.5 + u, y), left = cloth.at(0.5 - u, y);
      ASSERT_NEAR(right.height_mm, left.height_mm, 1e-9) << u << ", " << y;
      ASSERT_NEAR(right.normal.x, -left.normal.x, 1e-6) << u << ", " << y;
      ASSERT_NEAR(right.normal.y, left.normal.y, 1e-6) << u << ", " << y;
    }
  }
}

TEST(Knit, ShowsColumnsOfV) {
  const Knit cloth = knit();
  int legs = 0, points = 0;
  for (double y = 0.002; y < 0.75; y += 0.01) {
    for (double x = 0.002; x < 1; x += 0.01) {
      const SurfacePoint p = cloth.at(x, y);
      ++points;
      const double lean = p.along_x * p.along_y;  // negative: to the left going up
      legs += x < 0.5 ? lean < 0 : lean > 0;
    }
  }
  EXPECT_GT(legs, 0.85 * points) << "left legs lean to the left, right legs to the right, heads are hidden";
  EXPECT_NEAR(cloth.at(0.25, 0).height_mm, 0, 1e-12) << "the crest of a left leg";
  EXPECT_NEAR(cloth.at(0.75, 0).height_mm, 0, 1e-12) << "the crest of a right leg";
  EXPECT_LT(cloth.at(0.0, 0.1).height_mm, -0.1) << "the furrow between two wales";
}

TEST(Knit, NumbersItsCourses) {
  const Knit cloth = knit();
  for (int course = -3; course < 4; ++course) {
    const SurfacePoint p = cloth.at(0.25, course * 0.75);
    EXPECT_EQ(p.yarn.index, course);
    EXPECT_TRUE(p.yarn.is_weft);
  }
}

TEST(Knit, SlopesLikeARoundYarnAtAnyScale) {
  GeometrySettings g;
  const auto mean_slope_deg = [](const Knit& cloth, const GeometrySettings& s) {
    constexpr int kSteps = 100;
    double sum = 0;
    for (int j = 0; j < kSteps; ++j) {
      for (int i = 0; i < kSteps; ++i) {
        sum += angle_deg({0, 0, 1},
                         cloth.at((i + 0.5) / kSteps * s.wale_mm, (j + 0.5) / kSteps * s.course_mm).normal);
      }
    }
    return sum / (kSteps * kSteps);
  };
  const double slope_deg = mean_slope_deg(Knit(g), g);
  EXPECT_GT(slope_deg, 27);
  EXPECT_LT(slope_deg, 30);
  g.wale_mm *= 3;
  g.course_mm *= 3;
  EXPECT_NEAR(mean_slope_deg(Knit(g), g), slope_deg, 1e-3);
}

}  // namespace
}  // namespace weft::simulator
