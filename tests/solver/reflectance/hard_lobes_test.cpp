// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "solver/reflectance/measured_lobe.h"
#include "tests/solver/reflectance/pixels.h"

// Cloths and readings that a lobe is hard to tell from. Each is measured within its sigma, or refused.

namespace weft::solver {
namespace {

using testing::AnyOf;
using testing::Eq;

constexpr std::size_t kClothPixels = 400;

Lobe ggx(double alpha, double f0) {
  return {.family = LobeFamily::kGgx, .alpha = alpha, .f0 = f0};
}

MeasuredLobe found_in(const PixelTruth& cloth) {
  return measure_lobe(cloth.samples, cloth.start, 0);
}

MeasuredLobe found_in(const Lobe& lobe, const ClothOfPixels& cloth, std::uint64_t seed) {
  return found_in(pixels_of(model_of(lobe), kClothPixels, cloth, seed));
}

// The same cloth with other readings.
PixelTruth with_readings(const PixelTruth& cloth,
                         const std::function<void(std::vector<LobeReading>&)>& change) {
  PixelTruth changed;
  changed.b = cloth.b;
  changed.yarn = cloth.yarn;
  for (std::size_t i = 0; i < cloth.samples.pixels(); ++i) {
    const auto pixel = cloth.samples.of(i);
    std::vector<LobeReading> readings(pixel.begin(), pixel.end());
    change(readings);
    changed.samples.add(readings);
    for (LobeReading& r : readings) r.x = r.weight > 0 ? r.x : 0;
    changed.start.push_back(lambert_fit(readings));
  }
  return changed;
}

void expect_within_sigma(const MeasuredLobe& found, const Lobe& truth) {
  EXPECT_LT(std::abs(std::log(found.lobe.alpha / truth.alpha)), 3 * found.sigma_alpha)
      << "alpha " << found.lobe.alpha << " for " << truth.alpha;
  EXPECT_LT(std::abs(found.lobe.f0 - truth.f0), 3 * found.sigma_f0)
      << "f0 " << found.lobe.f0 << " for " << truth.f0;
}

// No number stands for a lobe that is refused.
void expect_nothing_said(const MeasuredLobe& found) {
  EXPECT_EQ(found.lobe, Lobe{});
  EXPECT_TRUE(found.points.empty());
  EXPECT_EQ(found.sigma_alpha, 0);
  for (const LobeCandidate& candidate : found.candidates)
    EXPECT_TRUE(std::isfinite(candidate.chi2 + candidate.lobe.alpha + candidate.lobe.f0));
}

TEST(HardLobe, OfAClusterTooSmallIsNotObservable) {
  const PixelTruth cloth = pixels_of(model_of(ggx(0.2, 0.04)), kLeastLobePixels + 40, {}, 1);
  EXPECT_TRUE(found_in(cloth).is_measured());
  int pixel = 0;
  const PixelTruth few = with_readings(cloth, [&](std::vector<LobeReading>& readings) {
    if (++pixel % 5 != 0) return;
    for (LobeReading& r : readings) r.weight = 0;
  });
  const MeasuredLobe found = found_in(few);
  EXPECT_EQ(found.refusal, LobeRefusal::kTooFewPixels) << "with 272 pixels that have readings";
  expect_nothing_said(found);
}

TEST(HardLobe, NarrowerThanLightsSampleIsNotObservable) {
  for (const double tilt : {1.0, 3.0, 10.0}) {
    const MeasuredLobe found = found_in(ggx(0.01, 0.04), {.tilt_deg = tilt}, 2);
    EXPECT_EQ(found.refusal, LobeRefusal::kLambertFits) << name_of(found.refusal) << " at " << tilt;
    expect_nothing_said(found);
  }
  // On steep cloth lights meet it here and there.
  for (const double alpha : {0.01, 0.015}) {
    const MeasuredLobe found = found_in(ggx(alpha, 0.04), {}, 2);
    EXPECT_EQ(found.refusal, LobeRefusal::kTooNarrow) << name_of(found.refusal) << " alpha " << alpha;
    expect_nothing_said(found);
  }
}

TEST(HardLobe, OfWhichLevelClothShowsTheTailAloneIsNotObservable) {
  for (const double alpha : {0.05, 0.1}) {
    const MeasuredLobe found = found_in(ggx(alpha, 0.04), {.tilt_deg = 1, .albedo = 0.05}, 3);
    if (found.is_measured()) {
      expect_within_sigma(found, ggx(alpha, 0.04));
    } else {
      EXPECT_EQ(found.refusal, LobeRefusal::kUncertain) << name_of(found.refusal) << " alpha " << alpha;
    }
  }
  EXPECT_EQ(found_in(ggx(0.1, 0.04), {.tilt_deg = 1}, 3).refusal, LobeRefusal::kUncertain);
}

// Beckmann's lobe of half the strength explains level cloth as well.
TEST(HardLobe, WhoseFamilyHalvesItsStrengthIsNotObservable) {
  const MeasuredLobe found = found_in(ggx(0.2, 0.04), {.tilt_deg = 1}, 4);
  EXPECT_EQ(found.refusal, LobeRefusal::kUncertain) << name_of(found.refusal);
  expect_nothing_said(found);
}

TEST(HardLobe, AsBroadAsShadingIsNotObservable) {
  for (const double alpha : {0.9, 1.0}) {
    const MeasuredLobe light = found_in(ggx(alpha, 0.04), {}, 5);
    EXPECT_EQ(light.refusal, LobeRefusal::kLambertFits) << name_of(light.refusal) << " alpha " << alpha;
    const MeasuredLobe dark = found_in(ggx(alpha, 0.04), {.albedo = 0.05}, 5);
    EXPECT_EQ(dark.refusal, LobeRefusal::kTooBroad) << name_of(dark.refusal) << " alpha " << alpha;
    expect_nothing_said(dark);
  }
}

TEST(HardLobe, OfAlphaZeroIsNotObservable) {
  const MeasuredLobe found = found_in(ggx(0.001, 0.04), {}, 6);
  EXPECT_EQ(found.refusal, LobeRefusal::kLambertFits) << name_of(found.refusal);
  expect_nothing_said(found);
}

TEST(HardLobe, WithoutStrengthIsNotObservable) {
  for (const double albedo : {0.4, 0.05}) {
    // Schlick's Fresnel leaves a mirror at grazing light even of f0 0.
    const MeasuredLobe none = found_in(ggx(0.3, 0), {.albedo = albedo}, 7);
    EXPECT_EQ(none.refusal, LobeRefusal::kLambertFits) << name_of(none.refusal);
    expect_nothing_said(none);
  }
  const MeasuredLobe weak = found_in(ggx(0.1, 0.01), {.albedo = 0.05}, 7);
  EXPECT_EQ(weak.refusal, LobeRefusal::kStrength) << name_of(weak.refusal);
  expect_nothing_said(weak);
}

// What saturates is left out: from here on only the tail is left, then too few readings.
TEST(HardLobe, WhoseReadingsAreSaturatedIsMeasuredByItsTailOrNotAtAll) {
  const Lobe truth = ggx(0.1, 0.05);
  const PixelTruth cloth = pixels_of(model_of(truth), kClothPixels, {.albedo = 0.1}, 8);
  const auto saturated_at = [&](double limit) {
    return found_in(with_readings(cloth, [limit](std::vector<LobeReading>& readings) {
      for (LobeReading& r : readings) r.weight = r.x < limit ? r.weight : 0;
    }));
  };
  const MeasuredLobe tail = saturated_at(0.15);
  ASSERT_TRUE(tail.is_measured()) << name_of(tail.refusal);
  expect_within_sigma(tail, truth);
  EXPECT_GT(tail.sigma_alpha, 2 * found_in(cloth).sigma_alpha);
  const MeasuredLobe less = saturated_at(0.075);
  EXPECT_EQ(less.refusal, LobeRefusal::kUncertain) << name_of(less.refusal);
  expect_nothing_said(less);
  const MeasuredLobe none = saturated_at(0.05);
  EXPECT_EQ(none.refusal, LobeRefusal::kTooFewPixels) << name_of(none.refusal);
  expect_nothing_said(none);
}

TEST(HardLobe, OfDarkClothUnderThreeLightsIsNotObservable) {
  const PixelTruth cloth = pixels_of(model_of(ggx(0.2, 0.04)), kClothPixels, {.albedo = 0.05}, 9);
  for (const int lights : {3, 4, 5}) {
    const MeasuredLobe found = found_in(with_readings(cloth, [lights](std::vector<LobeReading>& readings) {
      int used = 0;
      for (LobeReading& r : readings) r.weight = r.weight > 0 && ++used <= lights ? r.weight : 0;
    }));
    EXPECT_EQ(found.refusal, LobeRefusal::kTooFewPixels) << name_of(found.refusal) << ", " << lights;
    expect_nothing_said(found);
  }
}

TEST(HardLobe, OfPixelsWithoutReadingsIsNotObservable) {
  const PixelTruth cloth = pixels_of(model_of(ggx(0.2, 0.04)), kClothPixels, {}, 10);
  const MeasuredLobe none = found_in(with_readings(cloth, [](std::vector<LobeReading>& readings) {
    for (LobeReading& r : readings) r.weight = 0;
  }));
  EXPECT_EQ(none.refusal, LobeRefusal::kTooFewPixels) << name_of(none.refusal);
  const MeasuredLobe black = found_in(with_readings(cloth, [](std::vector<LobeReading>& readings) {
    for (LobeReading& r : readings) r.x = 0;
  }));
  EXPECT_EQ(black.refusal, LobeRefusal::kLambertFits) << name_of(black.refusal);
  expect_nothing_said(black);
}

TEST(HardLobe, IsFoundFromStartsThatAreNoNumbers) {
  PixelTruth cloth = pixels_of(model_of(ggx(0.2, 0.04)), kClothPixels, {}, 11);
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < kClothPixels; ++i) cloth.start[i] = i % 2 == 0 ? Vec3{none, 0, 0.3} : Vec3{};
  const MeasuredLobe found = found_in(cloth);
  ASSERT_TRUE(found.is_measured()) << name_of(found.refusal);
  expect_within_sigma(found, ggx(0.2, 0.04));
  EXPECT_LT(mean_angle_deg(found.fit.b, cloth.b), 0.3);
}

// Many half-vectors of such steep pixels lie below the horizon, and many lights too.
TEST(HardLobe, IsFoundWhereHalfVectorsLieBelowTheHorizon) {
  for (const double albedo : {0.4, 0.05}) {
    const PixelTruth cloth =
        pixels_of(model_of(ggx(0.2, 0.04)), kClothPixels, {.tilt_deg = 85, .albedo = albedo}, 12);
    std::size_t below = 0;
    for (std::size_t i = 0; i < kClothPixels; ++i) {
      for (const LobeReading& r : cloth.samples.of(i)) below += dot(cloth.b[i], r.from.half) < 0 ? 1U : 0U;
    }
    ASSERT_GT(below, 100U);
    const MeasuredLobe found = found_in(cloth);
    if (!found.is_measured()) {
      EXPECT_THAT(found.refusal, AnyOf(Eq(LobeRefusal::kTooFewPixels), Eq(LobeRefusal::kUncertain)))
          << name_of(found.refusal);
      continue;
    }
    expect_within_sigma(found, ggx(0.2, 0.04));
    for (const Vec3& b : found.fit.b) EXPECT_TRUE(std::isfinite(b.x + b.y + b.z));
  }
}

TEST(HardLobe, BelowItsHorizonReflectsNothingAndHasFiniteSlopes) {
  const Vec3 light = normalized({1, 0, 0.2}), view = {0, 0, 1};
  const LitFrom from(light, view);
  for (const Lobe& lobe :
       {ggx(0.02, 0.04), ggx(1, 0),
        Lobe{.family = LobeFamily::kAnisotropicGgx, .alpha = 0.4, .f0 = 0.05, .along = 0.3},
        Lobe{.family = LobeFamily::kBeckmann, .alpha = 0.1, .f0 = 0.04},
        Lobe{.family = LobeFamily::kTwoGgx, .alpha = 0.02, .f0 = 0.05, .broad = 1, .broad_share = 0.5}}) {
    for (int degree = 0; degree < 180; ++degree) {
      const Vec3 n = {std::sin(radians(degree)), 0, std::cos(radians(degree))};
      const ModelledReading m = modelled_with_derivative(lobe, 0.3 * n, from, 0);
      EXPECT_TRUE(std::isfinite(m.x + m.by_b.x + m.by_b.y + m.by_b.z)) << name_of(lobe.family) << degree;
      EXPECT_GE(m.x, 0) << name_of(lobe.family) << " at " << degree;
      if (dot(n, light) <= 0) {
        EXPECT_EQ(m.x, 0) << name_of(lobe.family) << " at " << degree;
      }
    }
  }
}

}  // namespace
}  // namespace weft::solver
