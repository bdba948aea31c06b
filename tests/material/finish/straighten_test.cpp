// SPDX-License-Identifier: Apache-2.0
#include "material/finish/straighten.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/statistics.h"
#include "core/solve/solve_record.h"
#include "tests/material/finish/cloths.h"
#include "tests/material/finish/repeating_share.h"

namespace weft::material {
namespace {

double share_of(const Straightened& found) {
  return repeating_share(found.surface, static_cast<double>(found.period_px.width) / found.repeats_x,
                         static_cast<double>(found.period_px.height) / found.repeats_y);
}

TEST(Straighten, PutsTheYarnsOnTheAxesAtNinePlaces) {
  const Size frame = {640, 640};
  for (const WeaveSettings& weave :
       {WeaveSettings{.binding = kTwill,
       .pitch_x_px = 10.2,
       .pitch_y_px = 9.1,
       .turn_deg = 2.1,
       .skew_deg = 1.5,
       .wander = 0.02,
       .warp_px = 1},
        WeaveSettings{
            .pitch_x_px = 9.3, .pitch_y_px = 10.7, .turn_deg = -1.8, .wander = 0.01, .bow_px = 5}}) {
    const Surface cloth = weave_surface(weave, frame);
    const Straightened found = straightened(cloth);
    EXPECT_LT(farthest_turn_deg(found, weave, frame), 0.05) << weave.binding.name;
    EXPECT_GT(farthest_turn_deg(straightened(cloth, {.lock_in_repeats = 0}), weave, frame), 0.1);
    EXPECT_NEAR(found.turn_deg, weave.turn_deg + weave.skew_deg, 0.1) << weave.binding.name;
    EXPECT_NEAR(found.skew_deg, -weave.skew_deg, 0.1) << weave.binding.name;
    EXPECT_GT(found.largest_pull_mm, 0.02) << weave.binding.name;
  }
}

TEST(Straighten, IsAskedAboutWhereTheTurnOrTheShearIsLarge) {
  Lattice lattice;
  lattice.turn_x_deg = -14.9;
  lattice.turn_y_deg = -12;
  EXPECT_FALSE(is_to_be_asked(lattice));
  lattice.turn_y_deg = -11.8;
  EXPECT_TRUE(is_to_be_asked(lattice)) << "sheared by 3.1 degrees";
  lattice.turn_x_deg = lattice.turn_y_deg = -15.1;
  EXPECT_TRUE(is_to_be_asked(lattice));
}

TEST(Straighten, MakesMoreOfTheReliefRepeat) {
  // A displacement with the wrong sign doubles the pulls.
  const WeaveSettings weave = {.binding = kSatin5,
                               .pitch_x_px = 9.3,
                               .pitch_y_px = 10.7,
                               .turn_deg = -0.8,
                               .wander = 0.03,
                               .warp_px = 1.5};
  const Surface cloth = weave_surface(weave, {512, 512});
  const double affine = share_of(straightened(cloth, {.lock_in_repeats = 0})),
               locked = share_of(straightened(cloth));
  EXPECT_GT(locked, 0.75);
  EXPECT_GT(locked, affine + 0.1);
}

TEST(Straighten, TurnsAndShearsSlopesAsASurfacesDo) {
  const WeaveSettings settings = {
      .binding = kTwill, .pitch_x_px = 16, .pitch_y_px = 14, .turn_deg = 8, .skew_deg = 3, .noise_deg = 0};
  const Size frame = {400, 400};
  const Straightened found = straightened(weave_surface(settings, frame), {.lock_in_repeats = 0});
  const Weave weave(settings);
  // In the cloth's own axes its slopes are known; straightened axes are those, in another scale each.
  const Vec2 across = weave.place({1, 0}, frame).at, up = weave.place({0, 1}, frame).at;
  std::vector<double> errors;
  for (int y = 20; y < found.surface.size().height - 20; y += 3) {
    for (int x = 20; x < found.surface.size().width - 20; x += 3) {
      const Lookup::Place place = found.lookup.at(x, y);
      const auto point = weave.top(weave.place(place.at, frame).at);
      const Vec2 column = {across.x * place.by_column.x + up.x * place.by_column.y, 0};
      const double right = point.dx * column.x * found.surface.mm_per_pixel / found.mm_per_pixel_x;
      errors.push_back(std::abs(static_cast<double>(found.surface.slope(x, y, 0)) -
                                right * settings.mm_per_pixel / found.surface.mm_per_pixel));
    }
  }
  EXPECT_LT(median(errors), 0.005);
}

TEST(Straighten, MakesRepeatsWholeAndStatesTheScaleOfEachAxis) {
  const WeaveSettings weave = {.binding = kTwill, .pitch_x_px = 9.7, .pitch_y_px = 11.3, .turn_deg = 1};
  const Surface cloth = weave_surface(weave, {512, 400});
  for (const double mm_per_pixel : {0.0, 0.03, 0.06}) {
    const Straightened found =
        straightened(cloth, {.mm_per_pixel = mm_per_pixel, .repeats_x = 3, .repeats_y = 2});
    EXPECT_EQ(found.repeats_x, 3);
    EXPECT_EQ(found.repeats_y, 2);
    const double width_mm = 3 * 4 * 9.7 * 0.04, height_mm = 2 * 4 * 11.3 * 0.04;
    EXPECT_NEAR(found.period_px.width * found.mm_per_pixel_x, width_mm, 2e-4 * width_mm);
    EXPECT_NEAR(found.period_px.height * found.mm_per_pixel_y, height_mm, 2e-4 * height_mm);
    EXPECT_NEAR(found.surface.mm_per_pixel, mm_per_pixel == 0 ? 0.04 : mm_per_pixel, 4e-4);
  }
}

TEST(Straighten, TurnsYarnAzimuthsAndKeepsHoles) {
  const WeaveSettings weave = {.binding = kTwill, .turn_deg = 5, .wander = 0.02};
  Surface cloth = weave_surface(weave, {400, 400});
  cloth.lobe = Image<float>(cloth.size(), 4);
  cloth.opacity = Image<float>(cloth.size());
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) {
      cloth.lobe(x, y, 0) = 0.45F;
      cloth.lobe(x, y, 2) = x < 200 ? 5.0F : 3.0F;
      const bool is_hole = std::hypot(x - 200, y - 200) < 20;
      cloth.opacity(x, y) = is_hole ? 0.0F : 1.0F;
      if (is_hole) cloth.status(x, y) = kNoSolution | kDark;
    }
  }
  const Straightened found = straightened(cloth, {.lock_in_repeats = 0});
  const Size size = found.surface.size();
  const int cx = size.width / 2, cy = size.height / 2;
  const auto azimuth_off = [](double a, double b) { return std::abs(std::remainder(a - b, 180.0)); };
  EXPECT_LT(azimuth_off(static_cast<double>(found.surface.lobe(20, cy, 2)), 0), 0.1);
  EXPECT_LT(azimuth_off(static_cast<double>(found.surface.lobe(size.width - 20, cy, 2)), -2), 0.1);
  EXPECT_EQ(found.surface.lobe(20, cy, 0), 0.45F);
  EXPECT_EQ(found.surface.status(cx, cy), kNoSolution | kDark);
  EXPECT_EQ(found.surface.slope(cx, cy, 0), 0);
  EXPECT_EQ(found.surface.sigma_deg(cx, cy), 180);
  EXPECT_NEAR(found.surface.opacity(cx, cy), 0, 1e-6);
  EXPECT_NEAR(found.surface.opacity(30, 30), 1, 1e-6);
  EXPECT_EQ(found.surface.status(30, 30), 0);
}

TEST(Straighten, RefusesAClothWithoutRepeatAndGridsThatMakeNoPicture) {
  const Surface felt = felt_surface({256, 256});
  const Result<Lattice> none = find_lattice(felt);
  ASSERT_TRUE(none);
  const Result<Straightened> refused = straighten(felt, *none);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().why, testing::HasSubstr("no way carries"));
  const Surface cloth = weave_surface({.wander = 0.02}, {256, 256});
  const Result<Lattice> lattice = find_lattice(cloth);
  ASSERT_TRUE(lattice);
  for (const double mm : {-1.0, 1e-6, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_FALSE(straighten(cloth, *lattice, {.mm_per_pixel = mm})) << mm;
  EXPECT_FALSE(straighten(cloth, *lattice, {.repeats_x = -1}));
}

TEST(Straighten, IsTheSameForAnyNumberOfThreads) {
  const Surface cloth = weave_surface({.binding = kTwill, .turn_deg = 3, .wander = 0.03}, {256, 256});
  const Straightened one = straightened(cloth, {.threads = 1}), many = straightened(cloth, {.threads = 5});
  ASSERT_EQ(one.surface.size(), many.surface.size());
  for (int y = 0; y < one.surface.size().height; ++y) {
    for (int x = 0; x < one.surface.size().width; ++x) {
      ASSERT_EQ(one.surface.slope(x, y, 0), many.surface.slope(x, y, 0)) << x << ", " << y;
      ASSERT_EQ(one.surface.albedo(x, y, 1), many.surface.albedo(x, y, 1)) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace weft::material
