// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/height_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "simulator/geometry/scene_surface.h"

namespace weft::simulator {
namespace {

/// Samples of a function of column and row.
std::shared_ptr<Image<float>> sampled(Size size, const std::function<double(int, int)>& height_mm) {
  auto image = std::make_shared<Image<float>>(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) (*image)(x, y) = static_cast<float>(height_mm(x, y));
  }
  return image;
}

TEST(HeightMap, ReproducesAQuadraticExactly) {
  // In whole eighths, so that float holds every sample; sample (5, 4) is at the table's centre.
  const auto quadratic = [](double x, double y) {
    return 0.5 * x * x - 0.25 * x * y + 0.125 * y * y + x - 2 * y;
  };
  const auto image = sampled({11, 9}, [&](int c, int r) { return quadratic(c - 5, 4 - r); });
  const HeightMap map(image, {2, 0, 0, 0, false});
  for (double x = -3.9; x < 3.9; x += 0.37) {
    for (double y = -2.9; y < 2.9; y += 0.29) {
      const SurfacePoint p = map.at(2 * x, 2 * y);
      ASSERT_NEAR(p.height_mm, quadratic(x, y), 1e-12) << x << ", " << y;
      const Vec3 normal = normal_of_slopes((x - 0.25 * y + 1) / 2, (-0.25 * x + 0.25 * y - 2) / 2);
      ASSERT_LT(length(p.normal - normal), 1e-12) << x << ", " << y;
    }
  }
}

TEST(HeightMap, HasItsFirstRowAtTheTopAndItsCentreAtTheOffset) {
  const auto image = sampled({3, 3}, [](int c, int r) { return 10 * r + c; });
  const HeightMap map(image, {0.5, 7, -2, 0, true});
  EXPECT_EQ(map.at(7, -2).height_mm, 11);
  EXPECT_EQ(map.at(7.5, -2).height_mm, 12) << "columns go to the right";
  EXPECT_EQ(map.at(7, -1.5).height_mm, 1) << "rows go down";
  const HeightMap turned(image, {0.5, 7, -2, 90, true});
  EXPECT_NEAR(turned.at(7, -1.5).height_mm, 12, 1e-9) << "columns go up, turned by 90 degrees";
}

TEST(HeightMap, HasNoSeamWhereItRepeats) {
  const auto image = sampled({6, 4}, [](int c, int r) { return (c * 7 + r * 5) % 11; });
  const HeightMap map(image, {1, 0, 0, 0, true});
  const Period period = map.period_mm().value();
  EXPECT_EQ(period.x_mm, 6);
  EXPECT_EQ(period.y_mm, 4);
  constexpr double kTiny_mm = 1e-9;
  for (double along = -3; along < 3; along += 0.17) {
    // The seam, half a sample beyond the border, and the border samples, where the polynomials meet.
    for (const double seam : {3.0, 2.5, -2.5}) {
      const SurfacePoint before = map.at(seam - kTiny_mm, along), behind = map.at(seam + kTiny_mm, along);
      ASSERT_NEAR(before.height_mm, behind.height_mm, 1e-6) << seam << ", " << along;
      ASSERT_LT(length(before.normal - behind.normal), 1e-6) << seam << ", " << along;
    }
    ASSERT_NEAR(map.at(along, along).height_mm, map.at(along + 12, along - 4).height_mm, 1e-12);
  }
}

TEST(HeightMap, StaysAtItsBordersHeightBeyondIt) {
  const auto image = sampled({4, 4}, [](int c, int r) { return c + 10 * r; });
  const HeightMap map(image, {1, 0, 0, 0, false});
  EXPECT_EQ(map.at(1e6, 1.5).height_mm, 3);
  EXPECT_EQ(map.at(-50, -80).height_mm, 30);
  EXPECT_EQ(map.at(-50, -80).normal, (Vec3{0, 0, 1}));
  EXPECT_FALSE(map.period_mm().has_value());
}

TEST(HeightMap, IsRefusedWithoutFiniteHeights) {
  GeometrySettings g;
  g.kind = GeometryKind::kHeightMap;
  EXPECT_FALSE(check_heights(g)) << "no picture";
  EXPECT_EQ(heights_mm(surface_of(g), {}).highest_mm, 0) << "a level plane, no crash";
  g.heights_mm = std::make_shared<Image<float>>(Size{4, 4}, 3);
  EXPECT_FALSE(check_heights(g)) << "three planes";
  const auto image = sampled({4, 4}, [](int, int) { return 1; });
  g.heights_mm = image;
  EXPECT_TRUE(check_heights(g));
  (*image)(2, 3) = std::numeric_limits<float>::quiet_NaN();
  const Result<void> refused = check_heights(g);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("column 2, row 3"), std::string::npos)
      << refused.error().message();
}

}  // namespace
}  // namespace weft::simulator
