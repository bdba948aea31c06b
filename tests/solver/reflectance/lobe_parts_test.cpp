// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>

#include "tests/solver/reflectance/lights_off.h"

namespace weft::solver {
namespace {

constexpr std::size_t kFramePixels = 480;
const Lobe kSatin = {.family = LobeFamily::kGgx, .alpha = 0.25, .f0 = 0.04};
// What half a percent of each LED does to alpha, and more.
constexpr double kSigmaAlpha = 0.01;

// A fit of one lobe to pixels of which every fourth lies in the same quarter, alpha of each times its factor.
struct Quarters {
  PixelTruth cloth;
  std::vector<std::size_t> part;
  LobeFit fit;
};

Quarters quarters_of(const Lobe& lobe, const std::array<double, kFrameParts>& factors, std::uint64_t seed) {
  Quarters quarters;
  std::array<PixelTruth, kFrameParts> truths;
  for (std::size_t p = 0; p < kFrameParts; ++p) {
    Lobe there = lobe;
    there.alpha *= factors[p];
    truths[p] =
        pixels_of(model_of(there), kFramePixels / kFrameParts, {.noise = 0.01}, kFrameParts * seed + p);
  }
  for (std::size_t i = 0; i < kFramePixels; ++i) {
    const PixelTruth& truth = truths[i % kFrameParts];
    quarters.cloth.samples.add(truth.samples.of(i / kFrameParts));
    quarters.cloth.b.push_back(truth.b[i / kFrameParts]);
    quarters.cloth.yarn.push_back(0);
    quarters.part.push_back(i % kFrameParts);
  }
  quarters.fit = fit_lobe(quarters.cloth.samples, {lobe, quarters.cloth.b, quarters.cloth.yarn, {}, 0},
                          {.fitted = parameters_of(lobe.family), .threads = 1});
  return quarters;
}

std::vector<LobePart> parts_of(const Quarters& q) {
  return measure_parts(q.cloth.samples, q.fit, q.part, kSigmaAlpha, 1);
}

TEST(LobeParts, OfClothThatIsTheSameAllOverDoNotDiffer) {
  double most = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<LobePart> parts = parts_of(quarters_of(kSatin, {1, 1, 1, 1}, seed));
    ASSERT_EQ(parts.size(), kFrameParts);
    for (const LobePart& part : parts) {
      most = std::max(most, std::abs(std::log(part.alpha / kSatin.alpha)) / part.sigma_alpha);
      EXPECT_EQ(part.pixels, kFramePixels / kFrameParts);
    }
    EXPECT_FALSE(change_across(parts)) << "seed " << seed;
  }
  EXPECT_LT(most, 4) << "sigmas of 80 parts";
  EXPECT_GT(most, 0.1) << "a sigma that is much too large says nothing";
}

TEST(LobeParts, OfWhichOneIsRougherAreTold) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto change = change_across(parts_of(quarters_of(kSatin, {0.95, 1, 1, 1.1}, seed)));
    ASSERT_TRUE(change) << "seed " << seed;
    EXPECT_EQ((*change)[0].part, 0U);
    EXPECT_STREQ(name_of_part((*change)[1].part), "lower right");
    EXPECT_NEAR((*change)[0].alpha, 0.95 * kSatin.alpha, 0.01 * kSatin.alpha);
    EXPECT_NEAR((*change)[1].alpha, 1.1 * kSatin.alpha, 0.01 * kSatin.alpha);
  }
}

TEST(LobeParts, OfTooFewPixelsSayNothing) {
  Quarters q = quarters_of(kSatin, {1, 1, 1, 1}, 1);
  for (std::size_t& part : q.part) part = part == 3 ? 2 : part;
  for (std::size_t i = 0; i < 10; ++i) q.part[i] = 3;
  EXPECT_EQ(parts_of(q).size(), 3U);
  q.part.assign(kFramePixels, 1);
  EXPECT_EQ(parts_of(q).size(), 1U);
  EXPECT_FALSE(change_across(parts_of(q)));
}

}  // namespace
}  // namespace weft::solver
