// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/led_gains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "core/base/vec.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kGainsFrame = {256, 192};
const std::vector<double> kTrueGains = {1.02, 0.985, 1.01, 0.97, 1.0, 1.015, 0.99, 1.03, 0.98, 1.005};

// A wave by lights that shine so many times as bright as their calibration says, with the noise of a camera
// and, of each reading, what `added` adds to it.
Photographs taken(const std::vector<double>& gains,
                  const std::function<double(std::size_t, int, int)>& added) {
  const DistantLights lights = ten_lights();
  Photographs photographs = mosaics(kGainsFrame, {.normal = wave}, lights);
  std::mt19937 random(5);
  for (std::size_t k = 0; k < gains.size(); ++k) {
    const NoiseModel noise = *photographs.noise();
    std::normal_distribution<double> normal(0, 1);
    photographs.mosaics()->frames[k] = frame_of(kGainsFrame, [&](int x, int y) {
      const DistantLight& light = lights.lights[k];
      const double lit = gains[k] * 0.5 * std::max(0.0, dot(wave(x, y), light.direction)) + added(k, x, y);
      return lit + std::sqrt(noise.variance(lit)) * normal(random);
    });
  }
  return photographs;
}

double nothing(std::size_t, int, int) {
  return 0;
}

TEST(LedGains, AreFoundOnAMattClothUpToOneOfEachHeight) {
  const auto found = find_led_gains(taken(kTrueGains, nothing), {}, {.threads = 1});
  ASSERT_TRUE(found && *found);
  const LedGains& gains = **found;
  EXPECT_TRUE(gains.is_kept());
  EXPECT_LT(gains.misfit_after, 1.2);
  EXPECT_GT(gains.misfit_before, 2 * gains.misfit_after);
  // Four lights stand high and six low: a line over the height is the mean of each.
  const auto mean_log = [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) sum += std::log(kTrueGains[k]);
    return sum / static_cast<double>(end - begin);
  };
  for (std::size_t k = 0; k < 10; ++k) {
    const double of_height = k < 4 ? mean_log(0, 4) : mean_log(4, 10);
    EXPECT_NEAR(std::log(gains.gain[k]), std::log(kTrueGains[k]) - of_height, 4 * gains.sigma[k] + 5e-4)
        << "light " << k;
  }
}

TEST(LedGains, AreNotSpokenOfWhereTheCalibrationIsRight) {
  const auto found = find_led_gains(taken(std::vector<double>(10, 1), nothing), {}, {.threads = 1});
  ASSERT_TRUE(found);
  EXPECT_FALSE(*found);
}

TEST(LedGains, AreNotTakenFromGloss) {
  const DistantLights lights = ten_lights();
  const auto gloss = [&](std::size_t k, int x, int y) {
    const Vec3 half = normalized(lights.lights[k].direction + Vec3{0, 0, 1});
    return 0.15 * std::pow(std::max(0.0, dot(wave(x, y), half)), 40);
  };
  for (const std::vector<double>& gains : {std::vector<double>(10, 1), kTrueGains}) {
    const auto found = find_led_gains(taken(gains, gloss), {}, {.threads = 1});
    ASSERT_TRUE(found);
    EXPECT_FALSE(*found);
  }
}

TEST(LedGains, OfAFlatClothAreNotTold) {
  Photographs flat = mosaics(kGainsFrame, {});
  const auto found = find_led_gains(flat, {}, {.threads = 1});
  ASSERT_TRUE(found);
  EXPECT_FALSE(*found);
  EXPECT_FALSE(*find_led_gains(developed(kGainsFrame, {.normal = wave}), {}, {})) << "no noise model";
}

TEST(LedGains, OfALedThatIsFaultyAreLeftToThoseWhoNameIt) {
  std::vector<double> gains(10, 1);
  gains[3] = 0.8;
  const auto found = find_led_gains(taken(gains, nothing), {}, {.threads = 1});
  ASSERT_TRUE(found);
  EXPECT_FALSE(*found);
}

}  // namespace
}  // namespace weft::solve
