// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/measured_lobe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/reflectance/pixels.h"

namespace weft::solver {
namespace {

constexpr std::size_t kPixels = 400;

TEST(MeasuredLobe, IsTheOneThatThePixelsHave) {
  const std::array<Lobe, 3> truths = {Lobe{.family = LobeFamily::kGgx, .alpha = 0.15, .f0 = 0.04},
                                      Lobe{.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.05},
                                      Lobe{.family = LobeFamily::kBeckmann, .alpha = 0.3, .f0 = 0.04}};
  for (const Lobe& truth : truths) {
    const PixelTruth cloth = pixels_of(model_of(truth), kPixels, {}, 5);
    const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
    ASSERT_EQ(found.refusal, LobeRefusal::kNone) << name_of(found.refusal) << " " << name_of(truth.family);
    EXPECT_EQ(found.lobe.family, truth.family);
    EXPECT_NEAR(found.lobe.alpha, truth.alpha, 0.01);
    EXPECT_NEAR(found.lobe.f0, truth.f0, 0.05 * truth.f0);
    const double before = mean_angle_deg(cloth.start, cloth.b), after = mean_angle_deg(found.fit.b, cloth.b);
    EXPECT_LT(after, 0.3) << "from " << before;
  }
}

TEST(MeasuredLobe, FindsTwoYarnsAndTheirAxis) {
  const Lobe truth = {
      .family = LobeFamily::kAnisotropicGgx, .alpha = 0.45, .f0 = 0.05, .along = 0.35, .axis = 0.35};
  const PixelTruth cloth = pixels_of(model_of(truth), kPixels, {.has_both_yarns = true}, 6);
  const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  ASSERT_EQ(found.refusal, LobeRefusal::kNone) << name_of(found.refusal);
  ASSERT_EQ(found.lobe.family, LobeFamily::kAnisotropicGgx);
  EXPECT_NEAR(found.lobe.alpha, 0.45, 0.02);
  EXPECT_NEAR(found.lobe.alpha * found.lobe.along, 0.1575, 0.01);
  EXPECT_NEAR(found.lobe.f0, 0.05, 0.0025);
  EXPECT_NEAR(degrees(found.lobe.axis), degrees(0.35), 2);
  std::size_t right = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (std::abs(found.fit.yarn[i] - cloth.yarn[i]) < 0.1) ++right;
  }
  EXPECT_GT(static_cast<double>(right) / kPixels, 0.97);
}

TEST(MeasuredLobe, OfDarkClothIsFoundFromTheWrongValley) {
  const Lobe truth = {.family = LobeFamily::kGgx, .alpha = 0.2, .f0 = 0.04};
  const PixelTruth cloth = pixels_of(model_of(truth), kPixels, {.albedo = 0.05}, 7);
  ASSERT_GT(mean_angle_deg(cloth.start, cloth.b), 8);
  const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  ASSERT_EQ(found.refusal, LobeRefusal::kNone) << name_of(found.refusal);
  EXPECT_NEAR(found.lobe.alpha, 0.2, 0.005);
  EXPECT_LT(mean_angle_deg(found.fit.b, cloth.b), 0.3);
}

TEST(MeasuredLobe, IsRefusedWhereLambertFits) {
  const PixelTruth cloth = pixels_of(model_of({}), kPixels, {}, 8);
  const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  EXPECT_EQ(found.refusal, LobeRefusal::kLambertFits);
  EXPECT_EQ(found.lobe, Lobe{});
}

// Broad lobes on light cloth look like a diffuse part that is bent.
TEST(MeasuredLobe, IsRefusedWhereABentDiffusePartExplainsItToo) {
  const PixelTruth cloth = pixels_of(model_of({.family = LobeFamily::kLambert, .bend = 0.3}), kPixels, {}, 9);
  EXPECT_FALSE(measure_lobe(cloth.samples, cloth.start, 0).is_measured());
}

TEST(MeasuredLobe, IsRefusedWhereReadingsFollowNoLaw) {
  const PixelModel noise = [](Vec3 n, double albedo, double, const LitFrom& from) {
    const double bits = 1e4 * (n.x + 3 * n.y + 7 * from.light.x + 11 * from.light.y);
    return albedo * (0.2 + std::abs(std::fmod(bits, 1.0)));
  };
  const PixelTruth cloth = pixels_of(noise, 400, {}, 10);
  EXPECT_FALSE(measure_lobe(cloth.samples, cloth.start, 0).is_measured());
}

TEST(MeasuredLobe, NeedsPixels) {
  const PixelTruth cloth = pixels_of(model_of({.family = LobeFamily::kGgx, .alpha = 0.2, .f0 = 0.04}),
                                     kLeastLobePixels - 1, {}, 11);
  EXPECT_EQ(measure_lobe(cloth.samples, cloth.start, 0).refusal, LobeRefusal::kTooFewPixels);
  EXPECT_EQ(measure_lobe(LobeSamples(10), {}, 0).refusal, LobeRefusal::kTooFewPixels);
}

TEST(MeasuredLobe, SaysSigmasThatItsErrorsKeep) {
  const Lobe truth = {.family = LobeFamily::kGgx, .alpha = 0.2, .f0 = 0.04};
  int beyond = 0;
  constexpr int kTrials = 4;
  for (std::uint64_t seed = 0; seed < kTrials; ++seed) {
    const PixelTruth cloth = pixels_of(model_of(truth), 400, {.noise = 0.01}, 100 + seed);
    const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
    ASSERT_TRUE(found.is_measured()) << name_of(found.refusal);
    beyond += std::abs(std::log(found.lobe.alpha / truth.alpha)) > 3 * found.sigma_alpha ? 1 : 0;
    beyond += std::abs(found.lobe.f0 - truth.f0) > 3 * found.sigma_f0 ? 1 : 0;
  }
  EXPECT_LE(beyond, 1) << "of " << 2 * kTrials << " beyond 3 sigma";
}

TEST(MeasuredLobe, IsTheSameForAnyNumberOfThreads) {
  const PixelTruth cloth =
      pixels_of(model_of({.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.04}), 330, {}, 12);
  const MeasuredLobe one = measure_lobe(cloth.samples, cloth.start, 1),
                     four = measure_lobe(cloth.samples, cloth.start, 4);
  EXPECT_EQ(one.lobe, four.lobe);
}

}  // namespace
}  // namespace weft::solver
