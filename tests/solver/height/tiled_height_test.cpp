// SPDX-License-Identifier: Apache-2.0
#include "solver/height/tiled_height.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"
#include "tests/solver/height/surface.h"

namespace weft::solver {
namespace {

using test::normals_of;
using test::planes_of;
using test::SurfacePoint;
using test::weave_with_folds;

TiledHeight tiled_of(const Image<float>& normals, const TiledHeightOptions& options = {},
                     View<const std::uint8_t> mask = {}) {
  Result<TiledHeight> height = tiled_height(rows_of(planes_of(normals), mask), options);
  if (!height) {
    ADD_FAILURE() << height.error().message();
    TiledHeight none;
    none.height_mm = Image<float>(normals.size());
    return none;
  }
  return std::move(height).value();
}

double worst_difference(View<const float> a, View<const float> b) {
  double worst = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) worst = std::max(worst, std::abs(double{a(x, y)} - b(x, y)));
  }
  return worst;
}

// Yarns of 10 pixels that lean a little, on waves of 900, 700 and 230 pixels up to 15 high.
SurfacePoint waved_weave(double x, double y) {
  struct Wave {
    double height, across, down;
  };
  SurfacePoint s = {0, 0, 0};
  for (const Wave& w : {Wave{0.8, 0.30, 0.02},
                        {0.8, -0.015, 0.31},
                        {15, 0.007, 0.002},
                        {9, -0.003, 0.0085},
                        {3, 0.02, 0.018}}) {
    const double turn = w.across * x + w.down * y;
    s.height += w.height * std::sin(turn);
    s.right += w.height * w.across * std::cos(turn);
    s.down += w.height * w.down * std::cos(turn);
  }
  return s;
}

TEST(TiledHeight, IsTheWholeSolveToHalfAHundredthOfAPixel) {
  Image<float> normals = normals_of({1410, 1083}, waved_weave);
  test::add_noise(normals, 0.25, 1);
  const Height whole = test::height_of(normals);
  const TiledHeight tiled = tiled_of(normals);
  const auto a = tiled.height_mm.plane(), b = whole.height_mm.plane();
  EXPECT_EQ(tiled.tiles, 6);
  EXPECT_EQ(tiled.iterated_tiles, 0);
  EXPECT_LT(test::rms_difference(a, b), 0.005);
  EXPECT_LT(worst_difference(a, b), 0.02);
  EXPECT_NEAR(test::mean_of(a), 0, 1e-5);
  EXPECT_NEAR(tiled.slope_residual_rms, whole.slope_residual_rms, 0.01 * whole.slope_residual_rms);
  // A fair trial: without the slow part, or without halos, it would be far off.
  EXPECT_GT(test::rms_of(b), 8);
}

TEST(TiledHeight, OfAnyShapeIsThatOfTheWhole) {
  for (const Size size : {Size{1, 1}, {1, 700}, {650, 1}, {7, 9}, {63, 65}, {513, 40}, {641, 8}}) {
    const Image<float> normals = normals_of(size, waved_weave);
    const TiledHeight tiled = tiled_of(normals, {.tile_px = 128, .halo_px = 64});
    const Height whole = test::height_of(normals);
    EXPECT_EQ(tiled.pixels, size.pixels());
    EXPECT_LT(worst_difference(tiled.height_mm.plane(), whole.height_mm.plane()), 0.1)
        << size.width << " x " << size.height;
  }
}

TEST(TiledHeight, HasTheSameBytesOnAnyNumberOfThreads) {
  Image<float> normals = normals_of({400, 330}, weave_with_folds);
  test::add_noise(normals, 1, 2);
  TiledHeightOptions options = {.tile_px = 128, .halo_px = 32};
  options.height.threads = 1;
  const TiledHeight one = tiled_of(normals, options);
  for (const int threads : {2, 7}) {
    options.height.threads = threads;
    const TiledHeight many = tiled_of(normals, options);
    EXPECT_TRUE(test::same_bytes(one.height_mm.plane(), many.height_mm.plane())) << threads << " threads";
    EXPECT_EQ(one.slope_residual_rms, many.slope_residual_rms);
  }
}

TEST(TiledHeight, IsInMillimetresAndRisesTheRightWay) {
  const auto plane = [](double x, double y) { return SurfacePoint{0.3 * x - 0.2 * y, 0.3, -0.2}; };
  TiledHeightOptions options = {.tile_px = 128, .halo_px = 64};
  options.height.mm_per_pixel = 0.05;
  const TiledHeight height = tiled_of(normals_of({301, 203}, plane), options);
  for (const auto& [x, y] : {std::pair{0, 0}, {300, 0}, {0, 202}, {300, 202}, {150, 101}}) {
    EXPECT_NEAR(height.height_mm(x, y), 0.05 * (0.3 * (x - 150) - 0.2 * (y - 101)), 1e-5) << x << ", " << y;
  }
}

TEST(TiledHeight, LeavesHolesOutAndIsRightAroundThem) {
  const Size size = {420, 300};
  Image<std::uint8_t> mask(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mask(x, y) = std::hypot(x - 200, y - 150) > 45;
  }
  const Image<float> normals = normals_of(size, waved_weave);
  const TiledHeight tiled = tiled_of(normals, {.tile_px = 256, .halo_px = 64}, mask.plane());
  const Height whole = test::height_of(normals, {}, mask.plane());
  EXPECT_GT(tiled.iterated_tiles, 0);
  EXPECT_EQ(tiled.pixels, whole.pixels);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (mask(x, y) == 0) {
        ASSERT_EQ(tiled.height_mm(x, y), 0);
      } else {
        ASSERT_NEAR(tiled.height_mm(x, y), whole.height_mm(x, y), 0.1) << x << ", " << y;
      }
    }
  }
}

TEST(TiledHeight, TakesRubbishAsAHoleAndCountsWhatItClamps) {
  Image<float> normals = normals_of({200, 150}, waved_weave);
  normals(50, 60, 0) = std::numeric_limits<float>::quiet_NaN();
  normals(51, 60, 2) = std::numeric_limits<float>::infinity();
  for (int p = 0; p < 3; ++p) normals(90, 20, p) = 0;
  normals(120, 100, 2) = -1;
  const TiledHeight height = tiled_of(normals, {.tile_px = 128, .halo_px = 32});
  EXPECT_EQ(height.pixels, 200 * 150 - 3);
  EXPECT_EQ(height.clamped, 1);
  EXPECT_TRUE(test::all_finite(height.height_mm.plane()));
  EXPECT_EQ(height.height_mm(50, 60), 0);
}

TEST(TiledHeight, RunsEveryMethodOnItsTiles) {
  const Image<float> normals = normals_of({300, 200}, waved_weave);
  const Height whole = test::height_of(normals);
  for (const auto method : {HeightMethod::kDct, HeightMethod::kMultigrid, HeightMethod::kSeed}) {
    TiledHeightOptions options = {.tile_px = 128, .halo_px = 64};
    options.height.method = method;
    const TiledHeight tiled = tiled_of(normals, options);
    EXPECT_EQ(tiled.iterated_tiles > 0, method == HeightMethod::kMultigrid);
    EXPECT_LT(test::rms_difference(tiled.height_mm.plane(), whole.height_mm.plane()),
              method == HeightMethod::kSeed ? 1 : 0.05);
  }
}

TEST(TiledHeight, WeighsANormalByItsSigma) {
  EXPECT_EQ(weight_of_sigma(0.5f, 0.5), 32);
  EXPECT_EQ(weight_of_sigma(1.0f, 0.5), 8);
  EXPECT_EQ(weight_of_sigma(0.0f, 0.5), 255);
  EXPECT_EQ(weight_of_sigma(100.0f, 0.5), 1);
  EXPECT_EQ(weight_of_sigma(180.0f, 0.5), 0);
  EXPECT_EQ(weight_of_sigma(std::numeric_limits<float>::quiet_NaN(), 0.5), 0);
}

TEST(TiledHeight, RefusesWhatCannotBeMeantAndPassesOnWhatItsRowsSay) {
  const Image<float> normals = normals_of({100, 80}, waved_weave);
  const auto kind_of = [](const NormalRows& rows, const TiledHeightOptions& options) {
    const Result<TiledHeight> height = tiled_height(rows, options);
    return height ? ErrorKind::kInternal : height.error().kind;
  };
  const NormalRows rows = rows_of(planes_of(normals), {});
  EXPECT_EQ(kind_of({}, {}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of(rows, {.tile_px = 32}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of(rows, {.tile_px = 128, .halo_px = 65}), ErrorKind::kUsage);
  EXPECT_EQ(kind_of(rows, {.height = {.mm_per_pixel = -1}}), ErrorKind::kUsage);
  const Image<std::uint8_t> nothing(normals.size());
  EXPECT_EQ(kind_of(rows_of(planes_of(normals), nothing.plane()), {}), ErrorKind::kBadData);
  const NormalRows broken = {normals.size(), [](int, const auto&, auto) -> Result<void> {
                               return Error{ErrorKind::kInputOutput, "disk", "", "gone", ""};
                             }};
  EXPECT_EQ(kind_of(broken, {}), ErrorKind::kInputOutput);
}

}  // namespace
}  // namespace weft::solver
