// SPDX-License-Identifier: Apache-2.0
#include "bench/base/bound.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "bench/accuracy/accuracy.h"
#include "simulator/sampling/random.h"

namespace weft::bench {
namespace {

constexpr double kStrength = 5, kAlbedo = 0.4, kFloor = 1e-4;
const std::vector<LightField::Light> kAxes = {
    {{1, 0, 0}, kStrength}, {{0, 1, 0}, kStrength}, {{0, 0, 1}, kStrength}};

TEST(CramerRao, IsTheNoiseOverTheSignalUnderThreePerpendicularLights) {
  const Vec3 normal = normalized({1, 1, 1});
  const double expected = degrees(std::sqrt(2 * kFloor) / (kStrength * kAlbedo));
  EXPECT_NEAR(cramer_rao(kAxes, normal, kAlbedo, {0, kFloor, 0}).rms_deg(), expected, 1e-12);
}

TEST(CramerRao, CountsPhotonNoiseByTheReadingOfEachLight) {
  // Frontal: only the light above gives signal; the two that tell the tilt have the floor alone.
  const double dim = cramer_rao(kAxes, {0, 0, 1}, kAlbedo, {1e-2, kFloor, 0}).rms_deg();
  EXPECT_NEAR(dim, degrees(std::sqrt(2 * kFloor) / (kStrength * kAlbedo)), 1e-12);
  const Vec3 normal = normalized({1, 1, 1});
  const double variance = 1e-2 * kAlbedo * kStrength / std::sqrt(3) + kFloor;
  EXPECT_NEAR(cramer_rao(kAxes, normal, kAlbedo, {1e-2, kFloor, 0}).rms_deg(),
              degrees(std::sqrt(2 * variance) / (kStrength * kAlbedo)), 1e-12);
}

TEST(CramerRao, DarkShotNoiseThatAllReadingsShareTiltsOnlyAcrossTheirSum) {
  const double shared = 3e-4;
  // The readings' common part lies along (1, 1, 1): no error of a normal that points there.
  const Vec3 along = normalized({1, 1, 1});
  EXPECT_NEAR(cramer_rao(kAxes, along, kAlbedo, {0, kFloor, shared}).rms_deg(),
              cramer_rao(kAxes, along, kAlbedo, {0, kFloor, 0}).rms_deg(), 1e-12);
  EXPECT_NEAR(cramer_rao(kAxes, {0, 0, 1}, kAlbedo, {0, kFloor, shared}).rms_deg(),
              degrees(std::sqrt(2 * (kFloor + shared)) / (kStrength * kAlbedo)), 1e-12);
}

TEST(CramerRao, IsInfiniteWithoutThreeLightsThatSpanSpace) {
  const std::vector<LightField::Light> two(kAxes.begin(), kAxes.begin() + 2);
  const std::vector<LightField::Light> fan = {{{1, 0, 0}, 1}, {{0, 0, 1}, 1}, {normalized({1, 0, 1}), 1}};
  for (const auto& lights : {std::vector<LightField::Light>(), two, fan}) {
    EXPECT_TRUE(std::isinf(cramer_rao(lights, {0, 0, 1}, kAlbedo, {0, kFloor, 0}).rms_deg()))
        << lights.size() << " lights";
  }
}

TEST(TangentCovariance, ChiSquareOfErrorsOfItsOwnCovarianceIsBelow228For68Percent) {
  const TangentCovariance c = {{1, 0, 0}, {0, 1, 0}, 4e-6, -1.2e-6, 1e-6};
  // Cholesky factor of the covariance.
  const double a = std::sqrt(c.c11), b = c.c12 / a, d = std::sqrt(c.c22 - b * b);
  int within = 0, within_doubled = 0;
  constexpr int kDraws = 40000;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const simulator::NormalPair z = simulator::normal_pair(simulator::philox({i, 0, 0, 0}, {1, 2}));
    const Vec3 estimate = normalized({a * z.first, b * z.first + d * z.second, 1});
    within += c.chi_square(estimate, c.rms_deg()) < 2.28 ? 1 : 0;
    within_doubled += c.chi_square(estimate, 2 * c.rms_deg()) < 2.28 ? 1 : 0;
  }
  EXPECT_NEAR(within / double{kDraws}, 1 - std::exp(-1.14), 0.01);
  EXPECT_NEAR(within_doubled / double{kDraws}, 1 - std::exp(-4 * 1.14), 0.01) << "a sigma twice too large";
}

TEST(LedsByBound, ThreeAreEveryOtherOfTheLowRingAndTenAreAll) {
  const auto three = leds_by_bound(3), ten = leds_by_bound(10);
  ASSERT_TRUE(three.has_value() && ten.has_value());
  EXPECT_EQ(*three, (std::vector<int>{5, 7, 9}));
  EXPECT_EQ(ten->size(), 10U);
}

}  // namespace
}  // namespace weft::bench
