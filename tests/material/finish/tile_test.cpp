// SPDX-License-Identifier: Apache-2.0
#include "material/finish/tile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/solve/solve_record.h"
#include "material/finish/seam.h"
#include "tests/material/finish/cloths.h"

namespace weft::material {
namespace {

Tile tile_from(const Surface& surface, const TilingOptions& options) {
  Result<Tile> found = tile(surface, options);
  EXPECT_TRUE(found) << found.error().message();
  return found ? std::move(found).value() : Tile();
}

TEST(Tile, OfAWeaveHidesItsJoints) {
  const WeaveSettings weave = {.binding = kTwill,
                               .pitch_x_px = 10.2,
                               .pitch_y_px = 9.1,
                               .turn_deg = 2.1,
                               .wander = 0.04,
                               .warp_px = 1};
  const Straightened cloth = straightened(weave_surface(weave, {640, 640}), {.repeats_x = 6, .repeats_y = 7});
  const Tile found = tile_from(cloth.surface, tile_of(cloth));
  EXPECT_EQ(found.surface.size(), cloth.period_px);
  EXPECT_TRUE(found.surface.is_tile);
  EXPECT_GT(found.places, 9);
  for (const auto& [seam, axis] : {std::pair{found.x, "x"}, {found.y, "y"}}) {
    EXPECT_LE(seam.wrap_step_slope, 1.0) << axis;
    EXPECT_LE(seam.wrap_step_albedo, 1.0) << axis;
    EXPECT_LE(seam.wrap_step_height, 1.0) << axis;
    EXPECT_GT(seam.gradient_slope, 0.9) << axis;
    EXPECT_LT(seam.gradient_slope, 1.1) << axis;
    EXPECT_GT(seam.gradient_albedo, 0.9) << axis;
    EXPECT_LT(seam.gradient_albedo, 1.1) << axis;
    EXPECT_GT(seam.residual, 0.85) << axis;
    EXPECT_LT(seam.residual, 1.15) << axis;
    EXPECT_LE(seam.curl, 1.1) << axis;
  }
  EXPECT_LT(found.normal_p99_at_cuts_deg, 1);
}

TEST(Tile, ShowsASeamThatIsBlurred) {
  const Surface felt = felt_surface({300, 200});
  const Overlap overlap = {Axis::kX, 240, 40};
  Cut cut;
  cut.column.assign(200, 20);
  const TilingOptions options;
  Tile found;
  found.surface = joined(felt, overlap, cut, options.feather_px);
  found.height_mm = Image<float>(found.surface.size());
  const Seam sharp = seam_of(found, felt, overlap, cut, 0, options);
  EXPECT_GT(sharp.gradient_slope, 0.9);
  EXPECT_GT(sharp.gradient_albedo, 0.9);
  const Surface before = joined(felt, overlap, cut, options.feather_px);
  for (int y = 0; y < 200; ++y) {
    for (int x = 16; x < 25; ++x) {
      const auto mean = [&](const Image<float>& map, int p) {
        return (map(x - 1, y, p) + map(x, y, p) + map(x + 1, y, p)) / 3;
      };
      for (int p = 0; p < 2; ++p) found.surface.slope(x, y, p) = mean(before.slope, p);
      for (int p = 0; p < 3; ++p) found.surface.albedo(x, y, p) = mean(before.albedo, p);
    }
  }
  const Seam blurred = seam_of(found, felt, overlap, cut, 0, options);
  EXPECT_LT(blurred.gradient_slope, 0.85);
  EXPECT_LT(blurred.gradient_albedo, 0.85);
}

TEST(Tile, HasAPeriodicHeightThatItsSlopesAgreeWith) {
  const WeaveSettings weave = {
      .binding = kSatin5, .pitch_x_px = 10, .pitch_y_px = 12, .turn_deg = 1, .wander = 0.03};
  const Straightened cloth = straightened(weave_surface(weave, {400, 400}));
  const Tile found = tile_from(cloth.surface, tile_of(cloth));
  const Size size = found.surface.size();
  double squares = 0, mean = 0;
  for (int y = 0; y < size.height; ++y) {
    const double rise = (static_cast<double>(found.surface.slope(0, y, 0)) +
                         static_cast<double>(found.surface.slope(size.width - 1, y, 0))) /
                        2 * found.surface.mm_per_pixel;
    const double step = static_cast<double>(found.height_mm(0, y) - found.height_mm(size.width - 1, y));
    squares += (step - rise) * (step - rise) / size.height;
  }
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mean += static_cast<double>(found.surface.slope(x, y, 0));
  }
  EXPECT_GT(found.relief_mm, 0.05);
  EXPECT_LT(std::sqrt(squares), 0.01 * found.relief_mm);
  EXPECT_LT(std::abs(mean / static_cast<double>(size.pixels())), 1e-4);
}

TEST(Tile, OfFeltIsCutWithoutARepeatAndSaysSo) {
  const Tile found = tile_from(felt_surface({320, 280}), {});
  EXPECT_FALSE(found.has_repeat);
  EXPECT_EQ(found.surface.size(), (Size{272, 232}));
  for (const Seam& seam : {found.x, found.y}) {
    EXPECT_GT(seam.gradient_slope, 0.85);
    EXPECT_LT(seam.gradient_slope, 1.15);
    EXPECT_GT(seam.gradient_albedo, 0.85);
    EXPECT_LT(seam.gradient_albedo, 1.15);
    EXPECT_LE(seam.wrap_step_slope, 1.1);
    EXPECT_EQ(seam.residual, 0);
  }
}

TEST(Tile, StartsWhereNothingIsMissing) {
  Surface felt = felt_surface({400, 400});
  for (int y = 10; y < 40; ++y) {
    for (int x = 20; x < 50; ++x) felt.status(x, y) = kNoSolution;
  }
  const Tile found = tile_from(felt, {.period_px = {200, 200}, .overlap_px = 40});
  EXPECT_GT(found.x0 + found.y0, 0);
  int unsolved = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) unsolved += (found.surface.status(x, y) & kNoSolution) != 0;
  }
  EXPECT_EQ(unsolved, 0);
}

TEST(Tile, RefusesWhatCannotBeJoined) {
  const Surface cloth = felt_surface({200, 200});
  const auto refusal = [&](const TilingOptions& options) {
    const Result<Tile> found = tile(cloth, options);
    EXPECT_FALSE(found);
    return found ? "" : found.error().why;
  };
  EXPECT_THAT(refusal({.period_px = {0, 0}, .repeat_x_px = 101, .repeat_y_px = 20}),
              testing::HasSubstr("a repeat along x"));
  EXPECT_THAT(refusal({.period_px = {196, 100}}), testing::HasSubstr("do not fit"));
  EXPECT_THAT(refusal({.period_px = {100, 90}, .repeat_x_px = 20, .repeat_y_px = 20}),
              testing::HasSubstr("4.500 repeats"));
  EXPECT_THAT(refusal({.period_px = {0, 0}, .feather_px = 0}), testing::HasSubstr("feather"));
  EXPECT_THAT(refusal({.period_px = {0, 0}, .repeat_x_px = std::nan("")}), testing::HasSubstr("repeat"));
  Tile found = tile_from(cloth, {});
  EXPECT_FALSE(tile(found.surface, {}));
  found.surface.is_tile = false;
  found.surface.albedo(3, 3, 0) = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(tile(found.surface, {}));
}

TEST(Tile, IsTheSameForAnyNumberOfThreads) {
  const Surface cloth = felt_surface({160, 150});
  const Tile one = tile_from(cloth, {.threads = 1}), many = tile_from(cloth, {.threads = 4});
  for (int y = 0; y < one.surface.size().height; ++y) {
    for (int x = 0; x < one.surface.size().width; ++x) {
      ASSERT_EQ(one.height_mm(x, y), many.height_mm(x, y)) << x << ", " << y;
      ASSERT_EQ(one.surface.slope(x, y, 1), many.surface.slope(x, y, 1)) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace weft::material
