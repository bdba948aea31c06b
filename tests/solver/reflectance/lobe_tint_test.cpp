// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_tint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/solver/reflectance/tinted_pixels.h"

namespace weft::solver {
namespace {

double mean_of(const Rgb& f0) {
  return kLuminance[0] * f0[0] + kLuminance[1] * f0[1] + kLuminance[2] * f0[2];
}

void expect_found(const DyedCloth& cloth, const Rgb& f0, double alpha, std::uint64_t seed) {
  const FoundTints found = found_of(Photographed(cloth, seed).readings());
  ASSERT_EQ(found.lobes.size(), 1U);
  const MeasuredLobe& lobe = found.lobes.front();
  ASSERT_TRUE(lobe.tint) << "without a tint " << name_of(found.grey.front().refusal) << ", with one "
                         << name_of(lobe.refusal);
  EXPECT_NEAR(lobe.lobe.alpha, alpha, 0.01);
  EXPECT_NEAR(lobe.lobe.f0, mean_of(f0), 0.03 * mean_of(f0));
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(lobe.tint->f0[c], f0[c], 0.04 * f0[c]) << "channel " << c;
    EXPECT_NEAR(lobe.lobe.tint[c], f0[c] / mean_of(f0), 0.04 * lobe.lobe.tint[c]) << "channel " << c;
    EXPECT_LT(std::abs(lobe.tint->f0[c] - f0[c]), 3 * lobe.tint->sigma[c]) << "channel " << c;
  }
}

TEST(LobeTint, OfAMosaicIsFoundThoughOneLobeForAllChannelsIsNone) {
  expect_found({.model = ggx(kGold)}, kGold, 0.3, 1);
  expect_found({.model = satin(kGold)}, kGold, 0.35, 2);
  expect_found({.model = ggx(kGold, 0.2), .albedo = {0.3, 0.3, 0.3}}, kGold, 0.2, 3);
}

TEST(LobeTint, OfRgbIsFoundInEachChannel) {
  expect_found({.model = ggx(kGold), .taken = Taken::kAsRgb, .pixels = 500}, kGold, 0.3, 4);
  expect_found({.model = satin(kGold), .taken = Taken::kAsRgb, .pixels = 500}, kGold, 0.35, 5);
}

TEST(LobeTint, IsNotFoundInClothWhoseHighlightsAreWhite) {
  const WhiteTrials trials = white_trials(4, 0);
  EXPECT_EQ(trials.measured, 4);
  EXPECT_EQ(trials.called + trials.changed, 0)
      << "the farthest ratio is off by " << trials.farthest << " sigma";
}

TEST(LobeTint, IsWithinThreeSigma) {
  const GoldenTrials trials = golden_trials(3, 0);
  EXPECT_EQ(trials.found, 3);
  EXPECT_EQ(trials.beyond, 0) << "rms of error over sigma " << trials.rms;
}

TEST(LobeTint, OfYarnsOnMattGroundIsTheirs) {
  const DyedCloth cloth = {
      .model = ggx(kGold), .albedo = {0.1, 0.09, 0.06}, .pixels = 1600, .weft = simulator::Lambert{}};
  const FoundTints found = found_of(Photographed(cloth, 7).readings());
  ASSERT_EQ(found.lobes.size(), 2U) << name_of(found.grey.front().refusal);
  ASSERT_TRUE(found.lobes[0].tint);
  EXPECT_FALSE(found.lobes[1].is_measured());
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(found.lobes[0].tint->f0[c], kGold[c], 0.05 * kGold[c]) << "channel " << c;
}

TEST(LobeTint, OfAChannelThatMirrorsNothingIsZero) {
  const Rgb f0 = {0.08, 0.06, 0};
  const FoundTints found = found_of(Photographed({.model = ggx(f0)}, 8).readings());
  ASSERT_TRUE(found.lobes.front().tint);
  EXPECT_NEAR(found.lobes.front().tint->f0[2], 0, 0.002);
  EXPECT_NEAR(found.lobes.front().tint->f0[0], 0.08, 0.004);
}

TEST(LobeTint, IsNotSaidWhereAChannelIsSaturated) {
  ColouredReadings readings =
      Photographed({.model = ggx(kGold), .taken = Taken::kAsRgb, .pixels = 400}, 9).readings();
  ChannelSamples without_red(10);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < readings.channels.of[c].pixels(); ++i) {
      std::vector<LobeReading> of(readings.channels.of[c].of(i).begin(), readings.channels.of[c].of(i).end());
      if (c == 0) std::ranges::for_each(of, [](LobeReading& r) { r.weight = 0; });
      without_red.add(i, of);
    }
  }
  readings.channels = std::move(without_red);
  const FoundTints found = found_of(readings);
  EXPECT_FALSE(found.lobes.front().tint);
  EXPECT_EQ(found.lobes.front().lobe, found.grey.front().lobe);
}

TEST(LobeTint, OfClothWithoutDiffusePartIsANumber) {
  const FoundTints found =
      found_of(Photographed({.model = ggx(kGold, 0.2), .albedo = {0, 0, 0}}, 10).readings());
  for (const MeasuredLobe& lobe : found.lobes) {
    for (std::size_t c = 0; lobe.tint && c < 3; ++c) {
      EXPECT_TRUE(std::isfinite(lobe.tint->f0[c]) && std::isfinite(lobe.tint->sigma[c])) << c;
      EXPECT_NEAR(lobe.tint->f0[c], kGold[c], 0.05 * kGold[c]) << c;
    }
  }
}

TEST(LobeTint, IsTheSameForAnyNumberOfThreads) {
  const ColouredReadings r = Photographed({.model = ggx(kGold)}, 11).readings();
  std::vector<MeasuredLobe> one = measure_materials(r.samples, r.start, 1), four = one;
  find_tints(r.samples, r.start, r.channels, {.threads = 1}, one);
  find_tints(r.samples, r.start, r.channels, {.threads = 4}, four);
  ASSERT_TRUE(one.front().tint && four.front().tint);
  EXPECT_EQ(one.front().lobe, four.front().lobe);
  EXPECT_EQ(one.front().tint->sigma, four.front().tint->sigma);
}

}  // namespace
}  // namespace weft::solver
