// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "core/rig/camera.h"
#include "solve/photographs/cut.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr float kFull = std::numeric_limits<float>::infinity();

TEST(HalfSize, MakesTheMeanOfEachCellOfDevelopedPhotographs) {
  Photographs photographs = developed({7, 5}, {});
  Image<float>& image = std::get<Developed>(photographs.frames).rgb[2];
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) image(x, y, 0) = static_cast<float>(x + 10 * y);
  }
  image(4, 2, 1) = kFull;
  const Result<Photographs> half = half_size(photographs, 1);
  ASSERT_TRUE(half) << half.error().message();
  EXPECT_EQ(half->size, (Size{3, 2})) << "the odd column and row are left out";
  EXPECT_EQ(half->planes().count, 3);
  const Image<float>& reduced = std::get<Developed>(half->frames).rgb[2];
  EXPECT_FLOAT_EQ(reduced(1, 1, 0), (22 + 23 + 32 + 33) / 4.0F);
  EXPECT_EQ(reduced(2, 1, 1), kFull) << "one of its four readings was";
  EXPECT_FLOAT_EQ(reduced(2, 1, 2), static_cast<float>(0.5 * std::cos(radians(35))));
}

TEST(HalfSize, MakesAPixelOfEachFilterCell) {
  Photographs photographs = mosaics({8, 6}, {.albedo = {0.2, 0.4, 0.8}});
  const Result<Photographs> half = half_size(photographs, 2);
  ASSERT_TRUE(half) << half.error().message();
  const Image<float>& reduced = std::get<Developed>(half->frames).rgb[0];
  const double cosine = std::cos(radians(35));
  EXPECT_NEAR(reduced(3, 2, 0), 0.2 * cosine, 1 / kRange);
  EXPECT_NEAR(reduced(3, 2, 1), 0.4 * cosine, 1 / kRange);
  EXPECT_NEAR(reduced(3, 2, 2), 0.8 * cosine, 1 / kRange);
}

TEST(HalfSize, SeesTheTableThroughACameraOfTwiceThePixels) {
  Photographs photographs = developed({40, 30}, {});
  photographs.camera = overhead_camera({40, 30}, 600, 0.1);
  const Result<Photographs> half = half_size(photographs, 1);
  ASSERT_TRUE(half) << half.error().message();
  const Vec3 cell = point_on_plane(*half->camera, 7, 4, 0);
  const Vec3 between = point_on_plane(*photographs.camera, 14.5, 8.5, 0);
  EXPECT_NEAR(cell.x, between.x, 1e-9);
  EXPECT_NEAR(cell.y, between.y, 1e-9);
}

TEST(HalfSize, IsRefusedToAPictureOfOneRow) {
  EXPECT_FALSE(half_size(developed({64, 1}, {}), 1));
}

TEST(Cut, IsThePartOfEachPhotographUnderTheSameLights) {
  const Cloth cloth = {.normal = wave, .albedo = {0.2, 0.4, 0.8}};
  const Photographs counts = mosaics({96, 64}, cloth), rgb = developed({96, 64}, cloth);
  for (const Photographs* whole : {&counts, &rgb}) {
    const Rect area = {26, 12, 66, 44};
    const Result<Photographs> part = cut(*whole, area);
    ASSERT_TRUE(part) << part.error().message();
    EXPECT_EQ(part->size, (Size{40, 32}));
    EXPECT_EQ(part->planes().count, whole->planes().count);
    Image<float> scratch({40, 32}), of_whole({40, 32});
    const auto cut_out = readings_of(part->frames, 5, {0, 0, 40, 32}, scratch.plane());
    const auto expected = readings_of(whole->frames, 5, area, of_whole.plane());
    for (std::size_t p = 0; p < expected.size(); ++p) EXPECT_EQ(cut_out[p](31, 17), expected[p](31, 17));
  }
}

TEST(SolveFrame, ByTheReferenceLevelOfAFlatClothTellsThatNoGateIsOpen) {
  const Photographs photographs = mosaics({64, 64}, {.albedo = {0.1, 0.1, 0.1}});
  WholeMaps maps(photographs.size);
  const solver::MethodName* reference = solver::find_method("reference");
  ASSERT_NE(reference, nullptr);
  const auto facts = solve_frame(photographs, *reference, kSolveTile, {.threads = 1}, std::ref(maps));
  ASSERT_TRUE(facts) << facts.error().message();
  ASSERT_TRUE(facts->reference);
  EXPECT_FALSE(facts->reference->gates.shadows());
  EXPECT_TRUE(facts->reference->rounds.empty());
  EXPECT_EQ(facts->tally.by_kernel, 64 * 64) << "no pixel is conditioned so badly that it asks for double";
  EXPECT_LT(angle_deg(maps.normal_at(30, 30), {0, 0, 1}), 0.01);
}

TEST(SolveFrame, ByAQuickLevelSaysNothingOfGates) {
  const Photographs photographs = developed({64, 64}, {});
  WholeMaps maps(photographs.size);
  const auto facts =
      solve_frame(photographs, *solver::find_method("fast"), kSolveTile, {.threads = 1}, std::ref(maps));
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_FALSE(facts->reference);
  EXPECT_EQ(facts->tally.unsolved, 0);
}

// Left of column 256 a highlight of its own strength in four of the ten readings; right of it readings that
// are off by up to 8 percent of the albedo to either side, as bounced light and wide lamps leave them.
Photographs glossy_beside_uneven() {
  Photographs photographs = developed({512, 256}, {.normal = wave});
  std::vector<Image<float>>& frames = std::get<Developed>(photographs.frames).rgb;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uneven(-0.04F, 0.04F);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 512; ++x) {
        const float gloss = k < 4 ? 0.1F + 0.05F * static_cast<float>(k) : 0.0F;
        const float added = x < 256 ? gloss : uneven(random);
        for (int c = 0; c < 3; ++c) frames[k](x, y, c) += added;
      }
    }
  }
  return photographs;
}

// Mean error of the normals in the left half and in the right, clear of where blocks are blended.
std::pair<double, double> errors_of_halves(const WholeMaps& maps) {
  std::pair<double, double> sum = {0, 0};
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 128; ++x) {
      sum.first += angle_deg(maps.normal_at(x, y), wave(x, y)) / (256 * 128);
      sum.second += angle_deg(maps.normal_at(384 + x, y), wave(384 + x, y)) / (256 * 128);
    }
  }
  return sum;
}

TEST(SolveFrame, ByRobustIsNowhereWorseThanByStandard) {
  const Photographs photographs = glossy_beside_uneven();
  WholeMaps by_standard(photographs.size), everywhere(photographs.size), by_block(photographs.size);
  const solver::MethodName& robust = solver::method_of(solver::Level::kRobust);
  const JobContext context = {.threads = 1};
  ASSERT_TRUE(
      solve_bands(photographs, *solver::standard_method(), kSolveTile, context, std::ref(by_standard)));
  ASSERT_TRUE(solve_bands(photographs, *robust.make(), kSolveTile, context, std::ref(everywhere)));
  const auto facts = solve_frame(photographs, robust, kSolveTile, context, std::ref(by_block));
  ASSERT_TRUE(facts) << facts.error().message();
  const auto [standard_left, standard_right] = errors_of_halves(by_standard);
  const auto [robust_left, robust_right] = errors_of_halves(everywhere);
  const auto [left, right] = errors_of_halves(by_block);
  EXPECT_LT(robust_left, 0.5 * standard_left) << "it takes highlights out";
  EXPECT_GT(robust_right, 1.05 * standard_right) << "it trusts too few readings";
  EXPECT_EQ(left, robust_left);
  EXPECT_EQ(right, standard_right);
  EXPECT_EQ(facts->robust_share, 0.5);
}

TEST(SolveFrame, ByReferenceSharesTheBlocksAsRobustDoes) {
  const Photographs photographs = glossy_beside_uneven();
  WholeMaps by_robust(photographs.size), by_reference(photographs.size);
  const auto solved = [&](solver::Level level, WholeMaps& maps) {
    return solve_frame(photographs, solver::method_of(level), kSolveTile, {.threads = 1}, std::ref(maps));
  };
  ASSERT_TRUE(solved(solver::Level::kRobust, by_robust));
  const auto facts = solved(solver::Level::kReference, by_reference);
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(facts->robust_share, 0.5);
  const auto [robust_left, robust_right] = errors_of_halves(by_robust);
  const auto [left, right] = errors_of_halves(by_reference);
  EXPECT_NEAR(left, robust_left, 0.02 * robust_left);
  EXPECT_NEAR(right, robust_right, 0.02 * robust_right);
  ASSERT_TRUE(facts->left_out);
  EXPECT_GT(error_of_all(*facts->left_out).readings, 1000U);
}

TEST(SolveFrame, SaysHowWellLeftOutLightsArePredicted) {
  const Photographs photographs = glossy_beside_uneven();
  for (const char* name : {"fast", "standard", "robust"}) {
    WholeMaps maps(photographs.size);
    const auto facts =
        solve_frame(photographs, *solver::find_method(name), kSolveTile, {.threads = 1}, std::ref(maps));
    ASSERT_TRUE(facts) << facts.error().message();
    ASSERT_TRUE(facts->left_out) << name;
    const solver::LeftOutError error = error_of_all(*facts->left_out);
    EXPECT_GT(error.median, 0.01) << name;
    EXPECT_LT(error.median, 0.5) << name;
    EXPECT_TRUE(std::isnan(error.noise_median)) << "developed photographs have no noise model";
  }
}

}  // namespace
}  // namespace weft::solve
