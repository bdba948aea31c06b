// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/detail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/solve/solve_record.h"
#include "tests/material/made_surface.h"

namespace weft::material {
namespace {

constexpr NormalBlend kBlends[] = {NormalBlend::kAddSlopes, NormalBlend::kWhiteout, NormalBlend::kRnm,
                                   NormalBlend::kBlendXy};

// A wave of 10 pixels on a tilted sheet, 25 pixels wide.
Surface wave() {
  Surface made = made_surface({25, 20}, [](int x, int y) {
    return std::array{0.1 + 0.3 * std::sin(2 * kPi * x / 10), -0.05 + 0.2 * std::cos(2 * kPi * y / 10)};
  });
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 25; ++x) {
      for (int c = 0; c < 3; ++c) {
        made.albedo(x, y, c) = static_cast<float>(0.1 * (c + 1) * (1 + 0.5 * std::sin(2 * kPi * x / 10)));
      }
    }
  }
  return made;
}

double mean_of(View<const float> plane, int width) {
  double sum = 0;
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < width; ++x) sum += double{plane(x, y)};
  }
  return sum / width / plane.height();
}

TEST(DetailLayer, HasNoTiltNoColourAndNoHeightOverWholeRepeats) {
  const Surface surface = wave();
  Image<float> height({25, 20});
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 25; ++x) height(x, y) = 0.7F;
  }
  const Result<DetailLayer> layer = detail_layer(surface, height.plane(), {.repeat = {10, 10}});
  ASSERT_TRUE(layer) << layer.error().message();
  EXPECT_NEAR(layer->facts.slope_x, 0.1, 1e-6);
  EXPECT_NEAR(layer->facts.slope_y, -0.05, 1e-6);
  EXPECT_NEAR(layer->facts.albedo[2], 0.3, 1e-6);
  EXPECT_NEAR(layer->facts.height_mm, 0.7, 1e-6);
  EXPECT_NEAR(layer->facts.share_of_frame, 20.0 / 25, 1e-12);
  EXPECT_NEAR(mean_of(layer->slope.plane(0), 20), 0, 1e-7);
  EXPECT_NEAR(mean_of(layer->albedo.plane(1), 20), 1, 1e-6);
  EXPECT_NEAR(mean_of(layer->height_mm.plane(), 20), 0, 1e-7);
  EXPECT_GT(std::abs(mean_of(layer->slope.plane(0), 25)), 0.01) << "over parts of repeats it would tilt";
}

TEST(DetailLayer, TakesTheWholeTileAndEverythingWhereNoRepeatIsKnown) {
  Surface surface = wave();
  const Result<DetailLayer> unknown = detail_layer(surface, {});
  surface.is_tile = true;
  const Result<DetailLayer> tile = detail_layer(surface, {}, {.repeat = {10, 10}});
  ASSERT_TRUE(unknown && tile);
  EXPECT_EQ(unknown->facts.share_of_frame, 1);
  EXPECT_EQ(tile->facts.share_of_frame, 1);
  EXPECT_EQ(tile->facts.slope_x, unknown->facts.slope_x);
  EXPECT_TRUE(tile->height_mm.empty());
}

TEST(DetailLayer, CountsASharedPixelByItsShare) {
  // Two repeats of 2.5 pixels: the fifth pixel counts wholly, the sixth not at all.
  const Surface surface = made_surface({6, 1}, [](int x, int) { return std::array{x < 5 ? 0.2 : 9.0, 0.0}; });
  const Result<DetailLayer> layer = detail_layer(surface, {}, {.repeat = {2.5, 1}});
  ASSERT_TRUE(layer);
  EXPECT_NEAR(layer->facts.slope_x, 0.2, 1e-6);
}

TEST(DetailLayer, LeavesOutHolesAndBlackChannels) {
  Surface surface = wave();
  surface.status(3, 3) = kNoSolution;
  surface.slope(3, 3, 0) = 1000;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 25; ++x) surface.albedo(x, y, 0) = 0;
  }
  const Result<DetailLayer> layer = detail_layer(surface, {}, {.repeat = {10, 10}});
  ASSERT_TRUE(layer);
  EXPECT_NEAR(layer->facts.slope_x, 0.1, 2e-3);
  EXPECT_EQ(layer->slope(3, 3, 0), 0);
  EXPECT_EQ(layer->albedo(3, 3, 1), 1);
  EXPECT_EQ(layer->albedo(7, 7, 0), 1);
}

TEST(DetailLayer, IsRefusedWithoutARepeatOrASolution) {
  Surface surface = wave();
  EXPECT_FALSE(detail_layer(surface, {}, {.repeat = {30, 10}}));
  const Image<float> other({3, 3});
  EXPECT_FALSE(detail_layer(surface, other.plane()));
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 25; ++x) surface.status(x, y) = kNoSolution;
  }
  EXPECT_FALSE(detail_layer(surface, {}));
}

TEST(NormalBlend, OfALevelBaseOrALevelDetailIsTheOther) {
  const Vec3 level = {0, 0, 1}, tilted = normalized({0.3, -0.5, 0.9});
  for (const NormalBlend blend : kBlends) {
    EXPECT_LT(angle_deg(blended(level, tilted, blend), tilted), 1e-6) << name_of(blend);
    EXPECT_LT(angle_deg(blended(tilted, level, blend), tilted), 1e-6) << name_of(blend);
    EXPECT_EQ(normal_blend_named(name_of(blend)), blend);
  }
}

TEST(NormalBlend, OfSlopesIsThatOfSummedHeightsAndReorientedThatOfTurnedDetail) {
  const double base = radians(30), detail = radians(20);
  const Vec3 b = {std::sin(base), 0, std::cos(base)}, along = {std::sin(detail), 0, std::cos(detail)};
  EXPECT_LT(
      angle_deg(blended(b, along, NormalBlend::kRnm), {std::sin(base + detail), 0, std::cos(base + detail)}),
      1e-9);
  const Vec3 summed = normalized({std::tan(base) + std::tan(detail), 0, 1});
  EXPECT_LT(angle_deg(blended(b, along, NormalBlend::kAddSlopes), summed), 1e-9);
  EXPECT_GT(angle_deg(blended(b, along, NormalBlend::kBlendXy), summed), 3) << "exact for neither";
}

TEST(NormalBlend, HasUnitLengthWhereBothAreSteep) {
  const Vec3 steep = normalized({1, 0, 0.01});
  for (const NormalBlend blend : kBlends) {
    EXPECT_NEAR(length(blended(steep, steep, blend)), 1, 1e-12) << name_of(blend);
  }
}

}  // namespace
}  // namespace weft::material
