// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "solver/reflectance/measured_lobe.h"
#include "tests/solver/reflectance/lights_off.h"

namespace weft::solver {
namespace {

constexpr int kTrials = 200;

struct Cloth {
  const char* name;
  Lobe lobe;
  ClothOfPixels pixels;
};

const Lobe kNarrow = {.family = LobeFamily::kGgx, .alpha = 0.2, .f0 = 0.04};
const Lobe kBeckmann = {.family = LobeFamily::kBeckmann, .alpha = 0.3, .f0 = 0.04};
const Lobe kSatin = {
    .family = LobeFamily::kAnisotropicGgx, .alpha = 0.45, .f0 = 0.05, .along = 0.35, .axis = 0.2};

// Noise and the errors of lights are drawn anew in each trial.
void expect_kept(const Cloth& cloth) {
  const double turn = 0.002;
  int beyond_alpha = 0, beyond_f0 = 0, measured = 0;
  double alpha2 = 0, f02 = 0;
  for (std::uint64_t seed = 0; seed < kTrials; ++seed) {
    Random random(9000 + seed);
    std::vector<LightError> errors;
    for (int k = 0; k < 10; ++k) {
      const double log_strength = kLightDrift * random.normal();
      const double x = random.normal(), y = random.normal(), z = random.normal();
      errors.push_back({log_strength, turn * Vec3{x, y, z}});
    }
    const PixelTruth truth = pixels_off(cloth.lobe, 400, cloth.pixels, errors, seed);
    MeasuredLobe found = measure_lobe(truth.samples, truth.start, 0);
    if (!found.is_measured()) continue;
    add_light_errors(covariance_of_lights(0, turn), found);
    const double alpha = std::log(found.lobe.alpha / cloth.lobe.alpha) / found.sigma_alpha,
                 f0 = (found.lobe.f0 - cloth.lobe.f0) / found.sigma_f0;
    beyond_alpha += std::abs(alpha) > 3 ? 1 : 0;
    beyond_f0 += std::abs(f0) > 3 ? 1 : 0;
    alpha2 += alpha * alpha;
    f02 += f0 * f0;
    ++measured;
  }
  fmt::print("{}: {} of {} measured, beyond 3 sigma: alpha {}, f0 {}; rms over sigma: {:.2f}, {:.2f}\n",
             cloth.name, measured, kTrials, beyond_alpha, beyond_f0, std::sqrt(alpha2 / measured),
             std::sqrt(f02 / measured));
  EXPECT_GE(measured, 195) << cloth.name;
  EXPECT_LE(beyond_alpha, 0.02 * kTrials) << cloth.name;
  EXPECT_LE(beyond_f0, 0.02 * kTrials) << cloth.name;
  // A sigma that is much too large says nothing either.
  EXPECT_GT(std::sqrt(alpha2 / measured), 0.2) << cloth.name;
  EXPECT_GT(std::sqrt(f02 / measured), 0.1) << cloth.name;
}

TEST(LobeSigma, OfGgxIsKeptByNinetyEightOfAHundredTrials) {
  expect_kept({"ggx", kNarrow, {.noise = 0.01}});
}
TEST(LobeSigma, OfDarkGgxIsKeptByNinetyEightOfAHundredTrials) {
  expect_kept({"dark ggx", kNarrow, {.albedo = 0.05, .noise = 0.01}});
}
TEST(LobeSigma, OfBeckmannIsKeptByNinetyEightOfAHundredTrials) {
  expect_kept({"beckmann", kBeckmann, {.noise = 0.01}});
}
TEST(LobeSigma, OfDarkSatinIsKeptByNinetyEightOfAHundredTrials) {
  expect_kept({"dark satin", kSatin, {.albedo = 0.06, .noise = 0.01, .has_both_yarns = true}});
}

}  // namespace
}  // namespace weft::solver
