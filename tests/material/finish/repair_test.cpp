// SPDX-License-Identifier: Apache-2.0
#include "material/finish/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/solve/solve_record.h"
#include "material/finish/color_correction.h"
#include "material/finish/crop.h"
#include "tests/material/weave.h"

namespace weft::material {
namespace {

const WeaveSettings kTwillCloth = {.binding = kTwill, .pitch_x_px = 12, .pitch_y_px = 12, .wander = 0.03};

Cell cell_of(const WeaveSettings& weave) {
  const double period = weave.binding.period();
  return {{period * weave.pitch_x_px, 0}, {0, period * weave.pitch_y_px}};
}

void spoil(Surface& surface, double x, double y, double radius) {
  for (int j = 0; j < surface.size().height; ++j) {
    for (int i = 0; i < surface.size().width; ++i) {
      if (std::hypot(i - x, j - y) > radius) continue;
      surface.slope(i, j, 0) = surface.slope(i, j, 1) = 0;
      for (int p = 0; p < 3; ++p) surface.albedo(i, j, p) = 0.9F;
      surface.status(i, j) = kNoSolution;
    }
  }
}

// Root mean square difference of the slopes within a circle, of two clouds of maps `dx`, `dy` pixels apart.
double difference(const Surface& a, const Surface& b, double x, double y, double radius, int dx = 0,
                  int dy = 0) {
  double sum = 0;
  int count = 0;
  for (int j = 0; j < a.size().height; ++j) {
    for (int i = 0; i < a.size().width; ++i) {
      if (std::hypot(i - x, j - y) > radius) continue;
      for (int p = 0; p < 2; ++p) {
        const double d = static_cast<double>(a.slope(i, j, p) - b.slope(i + dx, j + dy, p));
        sum += d * d;
      }
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

TEST(Repair, FillsASpotNoWorseThanRepeatsDiffer) {
  const Surface truth = weave_surface(kTwillCloth, {448, 448});
  for (const double radius : {12.0, 30.0}) {
    Surface bad = weave_surface(kTwillCloth, {448, 448});
    spoil(bad, 230, 210, radius);
    const double mm = bad.mm_per_pixel;
    const Spot spot = {.x_mm = 230.5 * mm, .y_mm = 210.5 * mm, .radius_mm = (radius + 0.5) * mm};
    const Result<Repaired> repaired = repair(std::move(bad), {.spots = {spot}, .cell = cell_of(kTwillCloth)});
    ASSERT_TRUE(repaired) << repaired.error().message();
    double natural = 0;
    for (const auto& [i, j] : {std::pair{2, 1}, {-2, 1}, {1, -2}, {-1, -2}})
      natural += difference(truth, truth, 230, 210, radius, 48 * i, 48 * j) / 4;
    const double error = difference(repaired->surface, truth, 230, 210, radius);
    EXPECT_LT(error, natural) << "radius " << radius;
    EXPECT_GT(error, 0) << "nothing was spoilt";
    EXPECT_EQ(repaired->surface.status(230, 210), 0);
    EXPECT_LT(repaired->filled[0].mismatch, 1);
    double worst = 0;
    for (int p = 0; p < 3; ++p)
      worst = std::max(worst, static_cast<double>(repaired->surface.albedo(230, 210, p)));
    EXPECT_LT(worst, 0.5);
  }
}

TEST(Repair, IsTheSameAgainFromItsRecipe) {
  Surface bad = weave_surface(kTwillCloth, {320, 320}), again = weave_surface(kTwillCloth, {320, 320});
  const double mm = bad.mm_per_pixel;
  const Spot spot = {.x_mm = 160 * mm, .y_mm = 150 * mm, .width_mm = 30 * mm, .height_mm = 18 * mm};
  const Result<Repaired> first =
      repair(std::move(bad), {.spots = {spot}, .cell = cell_of(kTwillCloth), .threads = 1});
  ASSERT_TRUE(first) << first.error().message();
  ASSERT_TRUE(first->filled[0].spot.source_px);
  const Result<Repaired> second = repair(std::move(again), {.spots = {first->filled[0].spot}, .threads = 3});
  ASSERT_TRUE(second) << second.error().message();
  EXPECT_EQ(difference(first->surface, second->surface, 160, 150, 40), 0);
  EXPECT_GT(first->filled[0].pixels, 500);
}

TEST(Repair, TakesNothingFromOtherSpots) {
  Surface bad = weave_surface(kTwillCloth, {320, 320});
  const double mm = bad.mm_per_pixel;
  std::vector<Spot> spots;
  for (const double x : {112.0, 160.0, 208.0}) {
    spoil(bad, x, 160, 9);
    spots.push_back({.x_mm = x * mm, .y_mm = 160 * mm, .radius_mm = 11 * mm});
  }
  const Result<Repaired> repaired = repair(std::move(bad), {.spots = spots, .cell = cell_of(kTwillCloth)});
  ASSERT_TRUE(repaired) << repaired.error().message();
  for (int y = 0; y < 320; ++y) {
    for (int x = 0; x < 320; ++x) {
      ASSERT_EQ(repaired->surface.status(x, y) & kNoSolution, 0) << x << ", " << y;
      ASSERT_LT(repaired->surface.albedo(x, y, 0), 0.7F) << x << ", " << y;
    }
  }
}

TEST(Repair, RefusesWhatItCannotFill) {
  const auto refusal = [](const Spot& spot, const Cell& cell) {
    const Result<Repaired> repaired =
        repair(weave_surface(kTwillCloth, {200, 200}), {.spots = {spot}, .cell = cell});
    EXPECT_FALSE(repaired);
    return repaired ? "" : repaired.error().why;
  };
  const Cell cell = cell_of(kTwillCloth);
  EXPECT_THAT(refusal({.x_mm = 99, .y_mm = 1, .radius_mm = 1}, cell), testing::HasSubstr("not in the cloth"));
  EXPECT_THAT(refusal({.x_mm = 4, .y_mm = 4}, cell), testing::HasSubstr("no pixel"));
  EXPECT_THAT(refusal({.x_mm = 4, .y_mm = 4, .radius_mm = 0.5}, {}), testing::HasSubstr("no repeat"));
  EXPECT_THAT(refusal({.x_mm = 4, .y_mm = 4, .radius_mm = 3.5}, cell), testing::HasSubstr("free, solved"));
}

TEST(Crop, CutsOutWholePixels) {
  const Surface cloth = weave_surface({.mm_per_pixel = 0.04}, {100, 80});
  const Result<Cropped> part = crop(cloth, {.left_mm = 0.41, .top_mm = 0.8, .width_mm = 2, .height_mm = 0});
  ASSERT_TRUE(part) << part.error().message();
  EXPECT_EQ(part->part_px, (Rect{10, 20, 60, 80}));
  EXPECT_EQ(part->surface.slope(3, 4, 1), cloth.slope(13, 24, 1));
  EXPECT_EQ(part->surface.albedo(3, 4, 2), cloth.albedo(13, 24, 2));
  EXPECT_FALSE(crop(cloth, {.left_mm = 3, .width_mm = 2}));
  EXPECT_FALSE(crop(cloth, {.left_mm = -1}));
  EXPECT_FALSE(crop(cloth, {.width_mm = 0.001}));
}

TEST(Color, MultipliesTheAlbedoAndCountsWhatIsAboveWhite) {
  Surface cloth = weave_surface({.tone = 0}, {64, 64});
  cloth.albedo(5, 6, 1) = 0.8F;
  const Result<Colored> colored = color(std::move(cloth), {.white_gains = {0.5, 1, 2}, .exposure = 1.5});
  ASSERT_TRUE(colored) << colored.error().message();
  EXPECT_NEAR(colored->surface.albedo(9, 9, 0), 0.3 * 0.75, 1e-6);
  EXPECT_NEAR(colored->surface.albedo(9, 9, 1), 0.3 * 1.5, 1e-6);
  EXPECT_NEAR(colored->surface.albedo(9, 9, 2), 0.3 * 3, 1e-6);
  EXPECT_NEAR(colored->share_above_white, 1.0 / 4096, 1e-9);
  EXPECT_FALSE(color(weave_surface({}, {64, 64}), {.exposure = 0}));
  EXPECT_FALSE(color(weave_surface({}, {64, 64}), {.exposure = std::nan("")}));
}

TEST(Scale, ChangesNoPixel) {
  const Result<Surface> scaled = scale(weave_surface({}, {64, 64}), 0.05);
  ASSERT_TRUE(scaled);
  EXPECT_EQ(scaled->mm_per_pixel, 0.05);
  EXPECT_EQ(scaled->slope(3, 4, 0), weave_surface({}, {64, 64}).slope(3, 4, 0));
  EXPECT_FALSE(scale(weave_surface({}, {64, 64}), -1));
}

}  // namespace
}  // namespace weft::material
