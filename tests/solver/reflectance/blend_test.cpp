// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/blend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/reflectance/lobe_fit.h"
#include "tests/solver/reflectance/simulated.h"

// Pixels of two materials at once. Their truth is the simulator's.

namespace weft::solver {
namespace {

constexpr int kDraws = 200;
const Lobe kInk = {.family = LobeFamily::kGgx, .alpha = 0.25, .f0 = 0.05};
const Lobe kGround = {.family = LobeFamily::kBeckmann, .alpha = 0.45, .f0 = 0.04};

// What the simulator has for a lobe of the solver.
PixelModel model_in_simulator(const Lobe& lobe) {
  const Rgb f0 = {lobe.f0, lobe.f0, lobe.f0};
  if (lobe.family == LobeFamily::kGgx)
    return simulated(simulator::Ggx{.alpha = lobe.alpha, .f0 = f0, .beneath = simulator::Beneath::kBalanced});
  if (lobe.family == LobeFamily::kBeckmann)
    return simulated(
        simulator::Beckmann{.alpha = lobe.alpha, .f0 = f0, .beneath = simulator::Beneath::kBalanced});
  return simulated(simulator::Lambert{});
}

PixelModel both(const Lobe& first, const Lobe& second, double second_share) {
  const PixelModel a = model_in_simulator(first), b = model_in_simulator(second);
  return [=](Vec3 n, double albedo, double yarn, const LitFrom& from) {
    return (1 - second_share) * a(n, albedo, yarn, from) + second_share * b(n, albedo, yarn, from);
  };
}

TEST(Blend, OfTwoMaterialsGivesThePixelItsNormalAndAlbedo) {
  for (const Lobe& second : {Lobe{}, kGround}) {
    Random random(31);
    double turned = 0, turned_alone = 0, astray = 0, astray_alone = 0, off = 0;
    for (int i = 0; i < kDraws; ++i) {
      const Vec3 n = random_normal(random, 25);
      const double albedo = 0.08, share = 0.2 + 0.6 * random.uniform();
      const auto readings = readings_of(both(kInk, second, share), n, albedo, 0, 0.003, random);
      const Vec3 start = lambert_fit(readings);
      const PixelFit one = fit_pixel(kInk, readings, start, 0, 12),
                     other = fit_pixel(second, readings, start, 0, 12);
      const Vec3 alone = one.cost < other.cost ? one.b : other.b;
      const BlendFit blend = fit_blend(kInk, second, readings, alone, 0);
      turned += angle_deg(blend.fit.b, n) / kDraws;
      turned_alone += angle_deg(alone, n) / kDraws;
      astray += std::abs(length(blend.fit.b) / albedo - 1) / kDraws;
      astray_alone += std::abs(length(alone) / albedo - 1) / kDraws;
      off += std::abs(blend.second_parts / 8.0 - share) / kDraws;
    }
    const char* name = name_of(second.family);
    EXPECT_LT(turned, 0.15 * turned_alone) << name << ": " << turned << " degrees from " << turned_alone;
    EXPECT_LT(astray, 0.1 * astray_alone) << name << ": " << astray << " of the albedo from " << astray_alone;
    EXPECT_LT(off, 0.05) << name;
  }
}

TEST(Blend, OfOneMaterialIsOfOne) {
  Random random(32);
  int whole = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Vec3 n = random_normal(random, 25);
    const Lobe& alone = i % 2 == 0 ? kInk : kGround;
    const auto readings = readings_of(model_in_simulator(alone), n, 0.08, 0, 0.003, random);
    const BlendFit blend = fit_blend(kInk, kGround, readings, 0.08 * n, 0);
    whole += blend.second_parts == (i % 2 == 0 ? 0U : kBlendParts) ? 1 : 0;
    EXPECT_LT(angle_deg(blend.fit.b, n), 1.5) << "pixel " << i;
  }
  EXPECT_GT(whole, 0.8 * kDraws);
}

TEST(Blend, KnowsItsVariances) {
  Random random(33);
  const Vec3 n = random_normal(random, 20);
  constexpr double kAlbedo = 0.2;
  const Blend truth = {kInk, kGround, 0.5};
  double along = 0, across = 0, said_along = 0, said_across = 0;
  for (int i = 0; i < kDraws; ++i) {
    // Noise as the weights have it.
    auto readings = readings_of(both(kInk, kGround, 0.5), n, kAlbedo, 0, 0, random);
    for (LobeReading& r : readings) r.x += random.normal() / std::sqrt(r.weight);
    const BlendFit fit = fit_blend(kInk, kGround, readings, kAlbedo * n, 0);
    const Vec3 error = fit.fit.b - kAlbedo * n;
    along += dot(error, n) * dot(error, n) / kDraws;
    across += (dot(error, error) - dot(error, n) * dot(error, n)) / kDraws;
    const BlendVariances v = variances_of(truth, {}, {}, readings, kAlbedo * n, 0);
    said_along += v.along_of_readings / kDraws;
    said_across += v.across_of_readings / kDraws;
    EXPECT_EQ(v.along_of_lobes + v.across_of_lobes, 0);
  }
  EXPECT_NEAR(std::sqrt(along / said_along), 1, 0.35);
  EXPECT_NEAR(std::sqrt(across / said_across), 1, 0.35);
}

TEST(Blend, OfALobeThatIsOffIsLessSure) {
  Random random(34);
  const auto readings = readings_of(both(kInk, kGround, 0.5), {0, 0, 1}, 0.1, 0, 0, random);
  Lobe off = kInk;
  off.f0 *= 1.1;
  const std::array<Lobe, 1> offs = {off};
  const BlendVariances half = variances_of({kInk, kGround, 0.5}, offs, {}, readings, {0, 0, 0.1}, 0),
                       little = variances_of({kInk, kGround, 0.875}, offs, {}, readings, {0, 0, 0.1}, 0);
  EXPECT_GT(half.along_of_lobes, 0);
  EXPECT_LT(little.along_of_lobes, half.along_of_lobes);
}

TEST(Blend, IsFiniteWhereNothingTellsTheShare) {
  Random random(35);
  for (int i = 0; i < 40; ++i) {
    const Vec3 n = random_normal(random, 85);
    auto readings = readings_of(model_in_simulator(kInk), n, 0.1, 0, 0.003, random);
    if (i % 4 == 1)
      for (LobeReading& r : readings) r.x = 0;
    if (i % 4 == 2)
      for (LobeReading& r : readings) r.weight = 0;
    for (const Lobe& second : {kInk, Lobe{}}) {
      const BlendFit fit = fit_blend(kInk, second, readings, 0.1 * n, 0);
      EXPECT_TRUE(std::isfinite(fit.fit.b.x + fit.fit.b.y + fit.fit.b.z + fit.fit.cost)) << i;
      EXPECT_LE(fit.second_parts, kBlendParts);
      const BlendVariances v = variances_of({kInk, second, 0.5}, {}, {}, readings, fit.fit.b, 0);
      EXPECT_FALSE(std::isnan(v.along_of_readings + v.across_of_readings)) << i;
      EXPECT_GE(v.along_of_readings, 0) << i;
    }
  }
}

TEST(StatusBlend, IsTheShareThatWasWritten) {
  for (unsigned parts = 0; parts <= kBlendParts; ++parts) {
    const unsigned status = kGlossy | status_of_blend(parts);
    EXPECT_EQ(second_share_of(status), parts / 8.0);
    EXPECT_LE(blend_of(status), kMostBlend);
    EXPECT_EQ(status & ~kBlendBits & ~kHowSolved, 0U);
  }
}

}  // namespace
}  // namespace weft::solver
