// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_tint.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/reflectance/reflectance.h"
#include "solver/reflectance/materials.h"
#include "tests/solver/reflectance/lights_off.h"

namespace weft::solver {
namespace {

using simulator::AnisotropicGgx;
using simulator::Beneath;
using simulator::Ggx;
using simulator::Reflectance;

constexpr Rgb kGold = {0.1, 0.08, 0.04}, kWhite = {0.05, 0.05, 0.05};
constexpr Rgb kDarkYarn = {0.06, 0.05, 0.03}, kRed = {0.5, 0.12, 0.04};

Reflectance ggx(const Rgb& f0, double alpha = 0.3) {
  return Ggx{.alpha = alpha, .f0 = f0, .beneath = Beneath::kBalanced};
}
Reflectance satin(const Rgb& f0) {
  return AnisotropicGgx{.alpha = 0.35, .anisotropy = 0.6, .f0 = f0};
}

enum class Taken { kAsMosaic, kAsRgb };

struct Cloth {
  Reflectance model;
  Rgb albedo = kDarkYarn;
  Taken taken = Taken::kAsMosaic;
  std::size_t pixels = 800;
  double noise = 0.005;
  double drift = 0, turn = 0, colour = 0;  // of the lights, one sigma
  double full = 1e9;                       // readings from here on are saturated
  Reflectance weft = model;                // of every other yarn, which lies across
};

// What is wrong with a light.
struct Off {
  double log_strength = 0;
  Vec3 turn;
  Rgb colour = {0, 0, 0};
};

struct Readings {
  LobeSamples samples{10};
  ChannelSamples channels{10};
  std::vector<Vec3> b, start;
};

// What the simulator reflects of a surface whose fibres run at an azimuth.
double reading_at(const Reflectance& model, const Rgb& albedo, Vec3 n, double azimuth, Vec3 l,
                  std::size_t c) {
  const double cosine = dot(n, l);
  if (!(cosine > 0)) return 0;
  const double x = std::cos(azimuth), y = std::sin(azimuth);
  const Vec3 t = normalized({x * n.z, y * n.z, -(x * n.x + y * n.y)}), s = cross(n, t);
  const auto local = [&](Vec3 d) { return Vec3{dot(d, t), dot(d, s), dot(d, n)}; };
  return kPi * cosine * simulator::evaluate(model, albedo, local(l), local({0, 0, 1}))[c];
}

class Photographed {
 public:
  Photographed(const Cloth& cloth, std::uint64_t seed) : cloth_(cloth), random_(seed) {
    for (int k = 0; k < 10; ++k) {
      Off off;
      off.log_strength = cloth.drift * random_.normal();
      const double x = random_.normal(), y = random_.normal(), z = random_.normal();
      off.turn = cloth.turn * Vec3{x, y, z};
      for (double& each : off.colour) each = cloth.colour * random_.normal();
      off_.push_back(off);
    }
  }

  Readings readings() {
    Readings all;
    for (std::size_t i = 0; i < cloth_.pixels; ++i) {
      const Vec3 n = random_normal(random_, 25);
      const double ink = 0.9 + 0.2 * random_.uniform();
      const bool is_weft = i % 8 >= 4;
      std::array<std::vector<LobeReading>, 3> of;
      for (std::size_t c = 0; c < 3; ++c) of[c] = of_channel(n, ink, is_weft, c);
      const std::size_t colour = i % 4 == 3 ? 1 : i % 4;
      const std::vector<LobeReading> fitted = cloth_.taken == Taken::kAsMosaic ? of[colour] : mixed(of);
      all.samples.add(fitted);
      all.start.push_back(lambert_fit(fitted));
      all.b.push_back(ink * cloth_.albedo[colour] * n);
      for (std::size_t c = 0; c < 3; ++c) {
        if (cloth_.taken == Taken::kAsRgb || c == colour) all.channels.add(i, of[c]);
      }
    }
    return all;
  }

 private:
  std::vector<LobeReading> of_channel(Vec3 n, double ink, bool is_weft, std::size_t c) {
    const std::vector<Vec3> told = ten_directions();
    std::vector<LobeReading> readings;
    Rgb albedo = cloth_.albedo;
    for (double& each : albedo) each *= ink;
    for (std::size_t k = 0; k < told.size(); ++k) {
      const Vec3 l = normalized(told[k] + off_[k].turn);
      const double bare =
          reading_at(is_weft ? cloth_.weft : cloth_.model, albedo, n, is_weft ? kPi / 2 : 0, l, c) *
          std::exp(off_[k].log_strength + off_[k].colour[c]);
      LitFrom from(told[k], {0, 0, 1});
      from.channel = static_cast<int>(c);
      readings.push_back(reading_of(bare, from, cloth_.noise, random_));
      if (bare >= cloth_.full) readings.back().weight = 0;
    }
    return readings;
  }

  // As LobeReader sums channels.
  static std::vector<LobeReading> mixed(const std::array<std::vector<LobeReading>, 3>& of) {
    std::vector<LobeReading> sum = of[1];
    for (std::size_t k = 0; k < sum.size(); ++k) {
      sum[k].x = 0;
      sum[k].from.channel = LitFrom::kMixed;
      bool counts = true;
      for (std::size_t c = 0; c < 3; ++c) {
        sum[k].x += kLuminance[c] * of[c][k].x;
        counts = counts && of[c][k].weight > 0;
      }
      sum[k].weight = counts ? 1 / std::pow(kLobeModelShare * std::max(sum[k].x, kLeastModelled), 2) : 0;
    }
    return sum;
  }

  const Cloth& cloth_;
  Random random_;
  std::vector<Off> off_;
};

struct Found {
  std::vector<MeasuredLobe> grey, lobes;
};

Found found_of(const Readings& r, double turn = 0) {
  Found found;
  found.grey = found.lobes = measure_materials(r.samples, r.start, 1);
  const std::vector<double> errors = covariance_of_lights(0, turn);
  find_tints(r.samples, r.start, r.channels, {.light_errors = errors, .threads = 1}, found.lobes);
  return found;
}

double mean_of(const Rgb& f0) {
  return kLuminance[0] * f0[0] + kLuminance[1] * f0[1] + kLuminance[2] * f0[2];
}

void expect_found(const Cloth& cloth, const Rgb& f0, double alpha, std::uint64_t seed) {
  const Found found = found_of(Photographed(cloth, seed).readings());
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

// Noise, lights and their colours are drawn anew.
TEST(LobeTint, IsNotFoundInFiftyClothsWhoseHighlightsAreWhite) {
  int called = 0, measured = 0;
  double most = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Cloth cloth = {.model = seed % 2 == 0 ? ggx(kWhite) : satin(kWhite),
                   .albedo = seed % 3 == 0 ? kRed : kDarkYarn,
                   .taken = seed % 5 == 0 ? Taken::kAsRgb : Taken::kAsMosaic,
                   .pixels = 500,
                   .noise = 0.01,
                   .drift = kLightDrift,
                   .turn = 0.002,
                   .colour = kColourDrift};
    const Found found = found_of(Photographed(cloth, 100 + seed).readings(), cloth.turn);
    ASSERT_EQ(found.lobes.size(), found.grey.size());
    for (std::size_t l = 0; l < found.lobes.size(); ++l) {
      EXPECT_EQ(found.lobes[l].lobe, found.grey[l].lobe) << "cloth " << seed;
      called += found.lobes[l].tint ? 1 : 0;
    }
    if (!found.lobes.front().is_measured()) continue;
    ++measured;
    const MeasuredLobe& lobe = found.lobes.front();
    const auto tint = measure_tint(lobe.fit, false, Photographed(cloth, 100 + seed).readings().channels, {});
    if (!tint) continue;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(tint->tint[c] - 1) / tint->sigma_of_tint[c]);
  }
  fmt::print("{} measured, {} called, the farthest ratio {:.1f} sigma off\n", measured, called, most);
  EXPECT_EQ(called, 0);
  EXPECT_GE(measured, 45);
}

TEST(LobeTint, IsWithinThreeSigmaWhereItIsFound) {
  int found_tints = 0, beyond = 0;
  double squares = 0;
  constexpr int kTrials = 20;
  for (std::uint64_t seed = 0; seed < kTrials; ++seed) {
    const Cloth cloth = {.model = seed % 2 == 0 ? ggx(kGold) : satin(kGold),
                         .taken = seed % 4 == 0 ? Taken::kAsRgb : Taken::kAsMosaic,
                         .pixels = 600,
                         .noise = 0.01,
                         .drift = kLightDrift,
                         .turn = 0.002,
                         .colour = kColourDrift};
    const Found found = found_of(Photographed(cloth, 200 + seed).readings(), cloth.turn);
    if (!found.lobes.front().tint) continue;
    ++found_tints;
    for (std::size_t c = 0; c < 3; ++c) {
      const double off = (found.lobes.front().tint->f0[c] - kGold[c]) / found.lobes.front().tint->sigma[c];
      squares += off * off;
      beyond += std::abs(off) > 3 ? 1 : 0;
    }
  }
  const double rms = std::sqrt(squares / (3 * std::max(found_tints, 1)));
  fmt::print("{} of {} found, {} beyond 3 sigma, rms over sigma {:.2f}\n", found_tints, kTrials, beyond, rms);
  EXPECT_GE(found_tints, kTrials - 1);
  EXPECT_LE(beyond, 1);
  EXPECT_GT(rms, 0.2);
}

TEST(LobeTint, OfYarnsOnMattGroundIsTheirs) {
  const Cloth cloth = {
      .model = ggx(kGold), .albedo = {0.1, 0.09, 0.06}, .pixels = 1600, .weft = simulator::Lambert{}};
  const Found found = found_of(Photographed(cloth, 7).readings());
  ASSERT_EQ(found.lobes.size(), 2U) << name_of(found.grey.front().refusal);
  ASSERT_TRUE(found.lobes[0].tint);
  EXPECT_FALSE(found.lobes[1].is_measured());
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(found.lobes[0].tint->f0[c], kGold[c], 0.05 * kGold[c]) << "channel " << c;
}

TEST(LobeTint, OfAChannelThatMirrorsNothingIsZero) {
  const Rgb f0 = {0.08, 0.06, 0};
  const Found found = found_of(Photographed({.model = ggx(f0)}, 8).readings());
  ASSERT_TRUE(found.lobes.front().tint);
  EXPECT_NEAR(found.lobes.front().tint->f0[2], 0, 0.002);
  EXPECT_NEAR(found.lobes.front().tint->f0[0], 0.08, 0.004);
}

TEST(LobeTint, IsNotSaidWhereAChannelIsSaturated) {
  Readings readings =
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
  const Found found = found_of(readings);
  EXPECT_FALSE(found.lobes.front().tint);
  EXPECT_EQ(found.lobes.front().lobe, found.grey.front().lobe);
}

TEST(LobeTint, OfClothWithoutDiffusePartIsANumber) {
  const Found found = found_of(Photographed({.model = ggx(kGold, 0.2), .albedo = {0, 0, 0}}, 10).readings());
  for (const MeasuredLobe& lobe : found.lobes) {
    for (std::size_t c = 0; lobe.tint && c < 3; ++c) {
      EXPECT_TRUE(std::isfinite(lobe.tint->f0[c]) && std::isfinite(lobe.tint->sigma[c])) << c;
      EXPECT_NEAR(lobe.tint->f0[c], kGold[c], 0.05 * kGold[c]) << c;
    }
  }
}

TEST(LobeTint, IsTheSameForAnyNumberOfThreads) {
  const Readings r = Photographed({.model = ggx(kGold)}, 11).readings();
  std::vector<MeasuredLobe> one = measure_materials(r.samples, r.start, 1), four = one;
  find_tints(r.samples, r.start, r.channels, {.threads = 1}, one);
  find_tints(r.samples, r.start, r.channels, {.threads = 4}, four);
  ASSERT_TRUE(one.front().tint && four.front().tint);
  EXPECT_EQ(one.front().lobe, four.front().lobe);
  EXPECT_EQ(one.front().tint->sigma, four.front().tint->sigma);
}

}  // namespace
}  // namespace weft::solver
