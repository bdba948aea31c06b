// SPDX-License-Identifier: Apache-2.0
#include "solver/left_out/left_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

namespace weft::solver {
namespace {

constexpr Size kFrame = {1024, 512};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Errors of four lights at every reporting patch: of the left half of the frame and of the right.
LeftOut with_errors(float left, float right, unsigned seed) {
  LeftOut out;
  out.grid = blocks_of(kFrame);
  out.lights = 4;
  out.patches = patches_of(kFrame, PatchUse::kReport);
  std::mt19937 random(seed);
  std::normal_distribution<float> scatter(0, 0.1F);
  for (const Patch& patch : out.patches) {
    for (std::int64_t i = 0; i < patch.pixels.pixels(); ++i) {
      out.scale.push_back(2);
      for (int k = 0; k < 4; ++k) {
        const float share = patch.pixels.x0 < kFrame.width / 2 ? left : right;
        out.reading.push_back(2);
        out.error.push_back(2 * share * (1 + scatter(random)));
        out.noise.push_back(0.02F);
      }
    }
  }
  return out;
}

// Three normals at a small angle a from their mean, 120 degrees apart: sqrt(2/3 * 3 a^2).
TEST(Jackknife, IsTheScatterOfTurnsTimesWhatTheyShare) {
  constexpr double kTilt = 0.01;
  std::vector<Vec3> normals;
  for (const double turn : {0.0, 2 * kPi / 3, 4 * kPi / 3})
    normals.push_back(normalized({kTilt * std::cos(turn), kTilt * std::sin(turn), 1}));
  EXPECT_NEAR(jackknife_deg(normals), degrees(kTilt * std::sqrt(2.0)), 1e-3);
  EXPECT_TRUE(std::isnan(jackknife_deg(std::span(normals).first(1))));
}

TEST(Patches, ThatChooseAndThatReportShareNoPixelAndAreEnoughOfTheFrame) {
  const std::vector<Patch> choose = patches_of(kFrame, PatchUse::kChoose),
                           report = patches_of(kFrame, PatchUse::kReport);
  std::set<std::pair<int, int>> cells;
  std::int64_t pixels = 0;
  for (const auto* patches : {&choose, &report}) {
    for (const Patch& patch : *patches) {
      const Rect& r = patch.pixels;
      EXPECT_EQ(r.x0 % kRowGroup, 0);
      EXPECT_EQ(patch.block, static_cast<std::size_t>(r.y0 / kBlock * 4 + r.x0 / kBlock));
      EXPECT_TRUE(cells.insert({r.x0 / 64, r.y0 / 64}).second) << "two patches in one cell";
      pixels += r.pixels();
    }
  }
  EXPECT_EQ(choose.size(), report.size());
  EXPECT_EQ(pixels * 512, 3 * kFrame.pixels()) << "1/256 and 1/512";
}

TEST(Patches, LieInsideSmallFrames) {
  for (const Size size : {Size{1, 1}, Size{70, 40}, Size{300, 129}}) {
    for (const PatchUse use : {PatchUse::kChoose, PatchUse::kReport}) {
      for (const Patch& patch : patches_of(size, use)) {
        EXPECT_LE(patch.pixels.x1, size.width);
        EXPECT_LE(patch.pixels.y1, size.height);
        EXPECT_LT(patch.block, blocks_of(size).count());
      }
    }
  }
}

TEST(Comparison, KeepsWhatIsBetterByMoreThanItsSigmaBlockByBlock) {
  const LeftOut a = with_errors(0.02F, 0.02F, 1), b = with_errors(0.01F, 0.03F, 2);
  const Comparison comparison = compare(a, b);
  ASSERT_EQ(comparison.blocks.size(), 8U);
  EXPECT_NEAR(comparison.blocks[0].mean, 0.01, 0.0005);
  EXPECT_NEAR(comparison.blocks[3].mean, -0.01, 0.0005);
  EXPECT_NEAR(comparison.frame.mean, 0, 0.0005);
  EXPECT_FALSE(comparison.frame.keeps());
  EXPECT_EQ(comparison.choice().weights(), (std::vector<float>{1, 1, 0, 0, 1, 1, 0, 0}));
}

TEST(Comparison, KeepsNothingThatIsTheSame) {
  const LeftOut a = with_errors(0.02F, 0.02F, 1);
  EXPECT_EQ(compare(a, a).choice().share(), 0);
}

TEST(Comparison, IsNotDecidedByAFewHugeErrors) {
  const LeftOut a = with_errors(0.02F, 0.02F, 1);
  LeftOut b = with_errors(0.01F, 0.01F, 2);
  for (std::size_t i = 0; i < b.error.size(); i += 50) b.error[i] = 1000;
  EXPECT_EQ(compare(a, b).choice().share(), 1) << "mean " << compare(a, b).frame.mean;
}

TEST(Comparison, CountsOnlyWhatBothPredict) {
  LeftOut a = with_errors(0.02F, 0.02F, 1);
  for (std::size_t i = 0; i < a.error.size(); i += 2) a.error[i] = kNaN;
  LeftOut b = a;
  for (std::size_t i = 0; i < b.error.size(); i += 2) b.error[i] = 1;
  EXPECT_EQ(compare(a, b).frame.mean, 0);
}

TEST(LeftOutError, IsRelativeToLitReadingsBesideWhatNoiseGives) {
  LeftOut out = with_errors(0.03F, 0.03F, 3);
  for (std::size_t i = 0; i < out.error.size(); i += 4) {
    out.reading[i] = 0.02F;  // in shadow
    out.error[i] = 5;
  }
  const LeftOutError shaded = error_of_light(out, 0), lit = error_of_light(out, 1);
  EXPECT_EQ(shaded.readings, 0U);
  EXPECT_NEAR(lit.median, 0.03, 0.0005);
  EXPECT_NEAR(lit.rms, 0.03, 0.0005);
  EXPECT_NEAR(lit.noise_rms, 0.01, 1e-6);
  EXPECT_NEAR(lit.noise_median, 0.006745, 1e-6);
  EXPECT_EQ(error_of_all(out).readings, 3 * lit.readings);
}

TEST(LeftOutError, CountsAnErrorOverTheBrightnessAsTheBrightness) {
  LeftOut out = with_errors(1000, 1000, 3);
  EXPECT_EQ(error_of_all(out).rms, 1);
}

TEST(LeftOutError, SkipsPixelsWithoutLight) {
  LeftOut out = with_errors(0.03F, 0.03F, 3);
  std::fill(out.scale.begin(), out.scale.end(), 0.0F);
  EXPECT_EQ(error_of_all(out).readings, 0U);
  EXPECT_EQ(compare(out, out).frame.patches, 0);
}

TEST(LeftOutNoise, IsThatOfTheReadingAndOfItsPrediction) {
  // Four lights; three of them along the axes, so that the prediction of the fourth is their sum over sqrt 3.
  const double s = 1 / std::sqrt(3.0);
  const std::vector<Vec3> directions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {s, s, s}};
  const std::vector<double> variances = {1, 4, 9, 16};
  std::vector<float> sigma(4);
  left_out_noise(directions, variances, sigma);
  EXPECT_NEAR(sigma[3], std::sqrt(16 + (1 + 4 + 9) / 3.0), 1e-5);
  // x_0 = sqrt 3 x_3 - x_1 - x_2.
  EXPECT_NEAR(sigma[0], std::sqrt(1 + 3 * 16 + 4 + 9.0), 1e-5);
}

TEST(LeftOutNoise, IsUnknownWhereTheOthersSpanNoNormal) {
  const std::vector<Vec3> directions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0.6, 0.8}};
  std::vector<float> sigma(4);
  left_out_noise(directions, std::vector<double>(4, 1.0), sigma);
  EXPECT_TRUE(std::isnan(sigma[0])) << "the others lie in one plane";
  EXPECT_NEAR(sigma[3], std::sqrt(2.0), 1e-6);
}

}  // namespace
}  // namespace weft::solver
