// SPDX-License-Identifier: Apache-2.0
#include "material/opacity/fill.h"

#include <gtest/gtest.h>

#include "core/solve/solve_record.h"
#include "tests/material/made_surface.h"

namespace weft::material {
namespace {

// Cloth of albedo 0.4 with a hole of 30 x 30 pixels that shows a black table.
Surface holed() {
  Surface surface = made_surface({60, 60}, [](int, int) { return std::array{0.25, -0.1}; });
  surface.opacity = Image<float>({60, 60});
  surface.lobe = Image<float>({60, 60}, 4);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) {
      const bool hole = x >= 15 && x < 45 && y >= 15 && y < 45;
      surface.opacity(x, y) = hole ? 0.0F : 1.0F;
      surface.lobe(x, y, 0) = 0.5F;
      surface.lobe(x, y, 1) = 0.2F;
      surface.lobe(x, y, 2) = x < 30 ? 179.0F : 1.0F;
      if (!hole) continue;
      surface.slope(x, y, 0) = 7;
      surface.lobe(x, y, 0) = 1;
      surface.status(x, y) = kDark;
      for (int c = 0; c < 3; ++c) surface.albedo(x, y, c) = 0.01F;
    }
  }
  return surface;
}

TEST(FillHoles, ReachesEightPixelsAndIsLevelBeyond) {
  Surface surface = holed();
  const FillFacts facts = fill_holes(surface, {.threads = 1});
  EXPECT_EQ(facts.filled + facts.levelled, 900);
  EXPECT_GE(facts.levelled, 14 * 14);
  EXPECT_NEAR(surface.slope(16, 30, 0), 0.25, 1e-6);
  EXPECT_NEAR(surface.albedo(20, 30, 1), 0.4, 1e-6);
  EXPECT_EQ(surface.slope(30, 30, 0), 0);
  EXPECT_NEAR(surface.albedo(30, 30, 2), 0.4, 1e-6);
  EXPECT_NEAR(surface.lobe(30, 30, 0), 0.35, 1e-6) << "as wide both ways";
  EXPECT_EQ(surface.lobe(30, 30, 0), surface.lobe(30, 30, 1));
  EXPECT_EQ(surface.opacity(30, 30), 0) << "what was filled is still known";
  EXPECT_EQ(surface.status(30, 30), kDark);
}

TEST(FillHoles, TakesTheYarnOfTheNearestAndNoMeanOfAzimuths) {
  Surface surface = holed();
  fill_holes(surface, {.threads = 1});
  EXPECT_EQ(surface.lobe(29, 16, 2), 179);
  EXPECT_EQ(surface.lobe(30, 16, 2), 1);
}

TEST(FillHoles, LeavesNothingThatAMipWouldBleed) {
  Surface surface = holed();
  fill_holes(surface, {});
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) {
      ASSERT_GT(surface.albedo(x, y, 0), 0.39F) << x << ' ' << y;
      ASSERT_LT(surface.slope(x, y, 0), 0.26F) << x << ' ' << y;
    }
  }
}

TEST(FillHoles, OfATileGoesOnAcrossTheBorder) {
  Surface surface = made_surface({40, 8}, [](int, int) { return std::array{0.3, 0.0}; });
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 20; ++x) surface.status(x, y) = kNoSolution;
  }
  surface.is_tile = true;
  EXPECT_EQ(fill_holes(surface, {.reach_px = 4}).filled, 8 * 8) << "four columns from each side";
  EXPECT_NEAR(surface.slope(0, 4, 0), 0.3, 1e-6);
}

TEST(FillHoles, WithoutAnyClothIsLevelAndBlack) {
  Surface surface = made_surface({9, 9}, [](int, int) { return std::array{0.3, 0.0}; });
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 9; ++x) surface.status(x, y) = kNoSolution;
  }
  EXPECT_EQ(fill_holes(surface, {}).levelled, 81);
  EXPECT_EQ(surface.slope(4, 4, 0), 0);
  EXPECT_EQ(surface.albedo(4, 4, 0), 0);
}

TEST(FillHoles, HasTheSameBytesForAnyNumberOfThreads) {
  Surface one = holed(), many = holed();
  fill_holes(one, {.threads = 1});
  fill_holes(many, {.threads = 5});
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) ASSERT_EQ(one.albedo(x, y, 0), many.albedo(x, y, 0));
  }
}

}  // namespace
}  // namespace weft::material
