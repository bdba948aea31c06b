// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "solver/reflectance/measured_lobe.h"
#include "tests/solver/reflectance/pixels.h"

// Readings through crossed films and through parallel ones of the same pixels.

namespace weft::solver {
namespace {

constexpr std::size_t kPairPixels = 400;

PixelTruth pair_of(const Lobe& lobe, const ClothOfPixels& cloth, std::uint64_t seed) {
  return pixels_by([&](Vec3 n, double albedo, double,
                       Random& random) { return pair_of_readings(lobe, n, albedo, cloth.noise, random); },
                   kPairPixels, cloth, seed, 2);
}

TEST(FilmPair, ShowsBroadLobesOnLightCloth) {
  for (const double alpha : {0.5, 0.6}) {
    const Lobe truth = {.family = LobeFamily::kGgx, .alpha = alpha, .f0 = 0.04};
    const PixelTruth cloth = pair_of(truth, {}, 31);
    const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
    ASSERT_TRUE(found.is_measured()) << name_of(found.refusal) << ", alpha " << alpha;
    EXPECT_EQ(found.lobe.family, LobeFamily::kGgx);
    EXPECT_NEAR(found.lobe.alpha, alpha, 0.01);
    EXPECT_NEAR(found.lobe.f0, 0.04, 0.05 * 0.04);
    EXPECT_LT(std::abs(std::log(found.lobe.alpha / alpha)), 3 * found.sigma_alpha);
  }
}

TEST(FilmPair, ShowsTheLobeOfLevelCloth) {
  const Lobe truth = {.family = LobeFamily::kGgx, .alpha = 0.6, .f0 = 0.04};
  const PixelTruth cloth = pair_of(truth, {.tilt_deg = 1}, 32);
  const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  ASSERT_TRUE(found.is_measured()) << name_of(found.refusal);
  EXPECT_NEAR(found.lobe.alpha, 0.6, 0.01);
  EXPECT_NEAR(found.lobe.f0, 0.04, 0.05 * 0.04);
}

TEST(FilmPair, ShowsSheen) {
  struct Pile {
    double alpha, albedo;
  };
  for (const Pile& pile : {Pile{0.3, 0.04}, Pile{0.7, 0.3}}) {
    const Lobe truth = {.family = LobeFamily::kCloth, .alpha = pile.alpha, .f0 = 0.04};
    const PixelTruth cloth = pair_of(truth, {.albedo = pile.albedo}, 33);
    const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
    ASSERT_TRUE(found.is_measured()) << name_of(found.refusal) << ", alpha " << pile.alpha;
    EXPECT_EQ(found.lobe.family, LobeFamily::kCloth);
    EXPECT_NEAR(found.lobe.alpha, pile.alpha, 0.01);
    EXPECT_NEAR(found.lobe.f0, 0.04, 0.05 * 0.04);
    double off = 0;
    for (std::size_t i = 0; i < kPairPixels; ++i)
      off += std::abs(length(found.fit.b[i]) / length(cloth.b[i]) - 1) / kPairPixels;
    EXPECT_LT(off, 0.01) << "albedo";
  }
}

TEST(FilmPair, OfMattClothShowsNoLobe) {
  const PixelTruth cloth = pair_of({}, {}, 34);
  EXPECT_EQ(measure_lobe(cloth.samples, cloth.start, 0).refusal, LobeRefusal::kLambertFits);
}

// One state alone does not tell sheen from a diffuse part that bends.
TEST(FilmPair, IsWhatSheenNeeds) {
  const Lobe truth = {.family = LobeFamily::kCloth, .alpha = 0.7, .f0 = 0.12};
  const PixelTruth cloth = pixels_of(model_of(truth), kPairPixels, {.tilt_deg = 40, .albedo = 0.05}, 35);
  const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  ASSERT_GT(found.candidates.size(), 1U) << "chi2 by Lambert's law " << found.candidates.front().chi2;
  for (const LobeCandidate& candidate : found.candidates)
    EXPECT_NE(candidate.lobe.family, LobeFamily::kCloth);
}

TEST(FilmPair, SharesOfALobeAreTheSameInTheKernelAndInDouble) {
  Random random(36);
  for (const LobeFamily family :
       {LobeFamily::kGgx, LobeFamily::kAnisotropicGgx, LobeFamily::kBeckmann, LobeFamily::kCloth}) {
    const Lobe lobe = {.family = family, .alpha = 0.4, .f0 = 0.05, .along = 0.4};
    const Vec3 n = random_normal(random, 25);
    const auto readings = pair_of_readings(lobe, n, 0.3, 0.01, random);
    const Vec3 start = lambert_fit(std::span(readings).first(10));
    const PixelFit exact = fit_pixel(lobe, readings, start, 0, 20);
    LobeBlock block(readings.size());
    block.put(0, readings);
    block.begin_at(0, start);
    fit_block(lobe, block, 20);
    EXPECT_LT(angle_deg(block.b(0), exact.b), 0.02) << name_of(family);
    EXPECT_NEAR(length(block.b(0)), length(exact.b), 1e-3 * length(exact.b)) << name_of(family);
    EXPECT_NEAR(static_cast<double>(block.cost[0]), exact.cost, 0.01 * exact.cost + 1e-3) << name_of(family);
  }
}

TEST(FilmPair, WhoseParallelShotsAreSaturatedIsAsOneStateAlone) {
  const Lobe truth = {.family = LobeFamily::kGgx, .alpha = 0.5, .f0 = 0.04};
  const PixelTruth cloth = pixels_by(
      [&](Vec3 n, double albedo, double, Random& random) {
        auto readings = pair_of_readings(truth, n, albedo, 0.003, random);
        for (std::size_t i = 10; i < 20; ++i) readings[i].weight = 0;
        return readings;
      },
      kPairPixels, {}, 38, 2);
  const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  EXPECT_EQ(found.refusal, LobeRefusal::kLambertFits) << name_of(found.refusal);
}

TEST(FilmPair, WithoutLeakIsFittedToTheParallelShotsAlone) {
  const Lobe truth = {.family = LobeFamily::kGgx, .alpha = 0.5, .f0 = 0.04};
  Random random(39);
  for (int i = 0; i < 100; ++i) {
    const Vec3 n = random_normal(random, 25);
    const auto readings = pair_of_readings(truth, n, 0.3, 0.003, random, 0);
    const PixelFit fit = fit_pixel(truth, readings, lambert_fit(std::span(readings).first(10)), 0, 20);
    ASSERT_TRUE(std::isfinite(fit.cost));
    EXPECT_LT(angle_deg(fit.b, n), 1);
  }
}

// A LED that is brighter than calibrated is so in both states.
TEST(FilmPair, CountsTheErrorOfALedOnce) {
  const Lobe truth = {.family = LobeFamily::kGgx, .alpha = 0.5, .f0 = 0.04};
  const PixelTruth cloth = pair_of(truth, {}, 37);
  const MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  ASSERT_TRUE(found.is_measured()) << name_of(found.refusal);
  ASSERT_EQ(found.by_lights.errors(), 10 * LobeByLights::kErrors);
  // All LEDs brighter alike make albedo and lobe brighter alike: F0 goes with them, alpha stays.
  double f0 = 0, log_alpha = 0;
  for (std::size_t k = 0; k < 10; ++k) {
    f0 += found.by_lights.change_of(LobeParameter::kF0)[k * LobeByLights::kErrors];
    log_alpha += found.by_lights.change_of(LobeParameter::kLogAlpha)[k * LobeByLights::kErrors];
  }
  EXPECT_NEAR(f0, found.lobe.f0, 0.1 * found.lobe.f0);
  EXPECT_NEAR(log_alpha, 0, 0.05);
}

}  // namespace
}  // namespace weft::solver
