// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "solver/reflectance/materials.h"
#include "tests/solver/reflectance/simulated.h"

// Cloths with a sharp and a broad lobe in every point. Their truth is the simulator's.

namespace weft::solver {
namespace {

constexpr std::size_t kTwoTonePixels = 400;

simulator::MixedGgx mixed(double sharp, double broad, double share, double f0) {
  return {.alpha = sharp, .second_alpha = broad, .second_share = share, .f0 = {f0, f0, f0}};
}

double mean_albedo_error(const MeasuredLobe& found, const PixelTruth& cloth) {
  double sum = 0;
  for (std::size_t i = 0; i < kTwoTonePixels; ++i)
    sum += std::abs(length(found.fit.b[i]) / length(cloth.b[i]) - 1) / static_cast<double>(kTwoTonePixels);
  return sum;
}

TEST(TwoLobes, OfDarkClothAreFoundAndGiveItsAlbedo) {
  const std::array<simulator::MixedGgx, 3> truths = {mixed(0.1, 0.4, 0.5, 0.05), mixed(0.2, 0.6, 0.6, 0.05),
                                                     mixed(0.12, 0.45, 0.3, 0.04)};
  for (const simulator::MixedGgx& truth : truths) {
    const PixelTruth cloth = pixels_of(simulated(truth), kTwoTonePixels, {.albedo = 0.08}, 21);
    const MeasuredLobe one = measure_lobe(cloth.samples, cloth.start, 0);
    const auto found = measure_two_lobes(cloth.samples, cloth.start, one, 0);
    ASSERT_TRUE(found) << "for alpha " << truth.alpha;
    const MeasuredLobe& two = *found;
    ASSERT_EQ(two.lobe.family, LobeFamily::kTwoGgx) << "for alpha " << truth.alpha;
    EXPECT_NEAR(two.lobe.alpha, truth.alpha, 0.05 * truth.alpha);
    EXPECT_NEAR(two.lobe.broad, truth.second_alpha, 0.05 * truth.second_alpha);
    EXPECT_NEAR(two.lobe.broad_share, truth.second_share, 0.05);
    EXPECT_NEAR(two.lobe.f0, truth.f0[1], 0.05 * truth.f0[1]);
    EXPECT_LT(std::abs(std::log(two.lobe.broad / truth.second_alpha)), 3 * two.sigma_broad);
    EXPECT_LT(std::abs(two.lobe.broad_share - truth.second_share), 3 * two.sigma_share);
    EXPECT_LT(mean_angle_deg(two.fit.b, cloth.b), 0.3);
    EXPECT_LT(mean_albedo_error(two, cloth), 0.015);
    if (one.is_measured()) {
      EXPECT_GT(mean_albedo_error(one, cloth), 5 * mean_albedo_error(two, cloth));
    }
  }
}

// Every family stays what it is by itself in clear cases.
TEST(TwoLobes, AreNotMadeOfOne) {
  const std::array<Lobe, 3> truths = {
      Lobe{.family = LobeFamily::kGgx, .alpha = 0.15, .f0 = 0.04},
      Lobe{.family = LobeFamily::kBeckmann, .alpha = 0.3, .f0 = 0.04},
      Lobe{.family = LobeFamily::kAnisotropicGgx, .alpha = 0.45, .f0 = 0.05, .along = 0.35, .axis = 0.3}};
  for (const Lobe& truth : truths) {
    const PixelTruth cloth =
        pixels_of(model_of(truth), kTwoTonePixels, {.albedo = 0.08, .has_both_yarns = true}, 22);
    const MeasuredLobe one = measure_lobe(cloth.samples, cloth.start, 0);
    EXPECT_EQ(one.lobe.family, truth.family);
    EXPECT_FALSE(measure_two_lobes(cloth.samples, cloth.start, one, 0).has_value()) << name_of(truth.family);
  }
}

TEST(TwoLobes, OfWhichOneHasAllOrOfOneRoughnessAreOne) {
  for (const auto& truth : {mixed(0.6, 0.2, 1, 0.04), mixed(0.2, 0.2, 0.5, 0.04)}) {
    const PixelTruth cloth = pixels_of(simulated(truth), kTwoTonePixels, {.albedo = 0.08}, 23);
    const std::vector<MeasuredLobe> found = measure_materials(cloth.samples, cloth.start, 0);
    ASSERT_EQ(found.size(), 1U);
    ASSERT_TRUE(found.front().is_measured()) << name_of(found.front().refusal);
    EXPECT_EQ(found.front().lobe.family, LobeFamily::kGgx) << "share " << truth.second_share;
    EXPECT_NEAR(found.front().lobe.alpha, 0.2, 0.01) << "share " << truth.second_share;
  }
}

// On level cloth every LED sees one tail.
TEST(TwoLobes, ThatAreNotToldAreLeftToOne) {
  const PixelTruth cloth =
      pixels_of(simulated(mixed(0.1, 0.4, 0.5, 0.05)), kTwoTonePixels, {.tilt_deg = 1, .albedo = 0.08}, 24);
  const MeasuredLobe one = measure_lobe(cloth.samples, cloth.start, 0);
  EXPECT_FALSE(measure_two_lobes(cloth.samples, cloth.start, one, 0).has_value());
}

TEST(TwoLobes, AreTheSameForAnyNumberOfThreads) {
  const PixelTruth cloth =
      pixels_of(simulated(mixed(0.12, 0.5, 0.5, 0.05)), kTwoTonePixels, {.albedo = 0.06}, 25);
  const MeasuredLobe one = measure_lobe(cloth.samples, cloth.start, 0);
  const auto alone = measure_two_lobes(cloth.samples, cloth.start, one, 1),
             four = measure_two_lobes(cloth.samples, cloth.start, one, 4);
  ASSERT_TRUE(alone && four);
  EXPECT_EQ(alone->lobe, four->lobe);
}

TEST(TwoLobes, LookLikeOneOfTheirHarmonicMean) {
  const Lobe two = {
      .family = LobeFamily::kTwoGgx, .alpha = 0.15, .f0 = 0.05, .broad = 0.5, .broad_share = 0.5};
  // What one lobe of GGX sends astray of what two do, by the cube root (Fores et al. 2012).
  const auto astray = [&](double alpha) {
    double sum = 0;
    Random random(26);
    for (int i = 0; i < 4000; ++i) {
      const Vec3 l = random_normal(random, 80), v = random_normal(random, 60);
      const LitFrom from(l, v);
      const auto reading = [&](const Lobe& lobe) { return std::cbrt(modelled(lobe, {0, 0, 0.06}, from, 0)); };
      sum += std::pow(reading({.family = LobeFamily::kGgx, .alpha = alpha, .f0 = 0.05}) - reading(two), 2);
    }
    return sum;
  };
  const double chosen = astray(alpha_of_one(two));
  EXPECT_NEAR(alpha_of_one(two), 2 / (1 / 0.15 + 1 / 0.5), 1e-12);
  for (const double alpha : {two.alpha, two.broad, (two.alpha + two.broad) / 2})
    EXPECT_LT(chosen, 0.7 * astray(alpha)) << "alpha " << alpha;
  EXPECT_EQ(alpha_of_one({.family = LobeFamily::kGgx, .alpha = 0.3}), 0.3);
}

}  // namespace
}  // namespace weft::solver
