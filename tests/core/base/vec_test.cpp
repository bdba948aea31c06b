// SPDX-License-Identifier: Apache-2.0
#include "core/base/vec.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

// Two unit vectors `angle_rad` apart in no special direction.
double angle_seen_deg(double angle_rad) {
  const Vec3 a = normalized({0.3, -0.5, 0.8});
  const Vec3 across = normalized(cross(a, {0.1, 0.9, 0.4}));
  return angle_deg(a, std::cos(angle_rad) * a + std::sin(angle_rad) * across);
}

TEST(AngleDeg, IsExactFromABillionthOfADegreeToHalfATurn) {
  for (const double angle : {1e-9, 1e-6, 1e-3, 0.03, 1.0, 45.0, 89.999999, 90.0, 135.0, 179.999999}) {
    EXPECT_NEAR(angle_seen_deg(radians(angle)), angle, 1e-13 * (1 + angle)) << angle << " degrees";
  }
  EXPECT_EQ(angle_deg({0, 0, 1}, {0, 0, 1}), 0);
  EXPECT_EQ(angle_deg({0, 0, 1}, {0, 0, -1}), 180);
}

TEST(AngleDeg, DoesNotDependOnLength) {
  EXPECT_NEAR(angle_deg({3, 0, 0}, {0.001, 0.001, 0}), 45, 1e-13);
  EXPECT_NEAR(angle_deg({1e150, 0, 0}, {0, 1e-150, 0}), 90, 1e-13);
}

TEST(Vec3, CrossProductIsRightHandedAndNormalToBoth) {
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1}));
  const Vec3 a = {1, 2, 3}, b = {-4, 5, 0.5};
  EXPECT_EQ(dot(cross(a, b), a), 0);
  EXPECT_EQ(dot(cross(a, b), b), 0);
}

TEST(Vec3, IsNormalizedWithoutOverflow) {
  for (const double size : {1e-200, 1.0, 1e200}) {
    const Vec3 v = normalized({3 * size, 0, 4 * size});
    EXPECT_NEAR(v.x, 0.6, 1e-15) << size;
    EXPECT_NEAR(v.z, 0.8, 1e-15) << size;
  }
}

TEST(Mat3, MultipliesByRows) {
  const Mat3 m = {{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  EXPECT_EQ(m * Vec3({1, 0, 0}), (Vec3{1, 4, 7}));
  EXPECT_EQ(m * Vec3({0, 1, -1}), (Vec3{-1, -1, -1}));
}

}  // namespace
}  // namespace weft
