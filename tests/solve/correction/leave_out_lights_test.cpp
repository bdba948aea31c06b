// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/leave_out_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

using solver::LeftOut;
using solver::PatchUse;

constexpr Size kSize = {520, 300};

LeftOut left_out(const Photographs& photographs, const SolveVariant& variant, int threads = 1) {
  Result<LeftOut> made = leave_out_lights(photographs, variant,
                                          solver::patches_of(photographs.size, PatchUse::kReport), {threads});
  EXPECT_TRUE(made);
  return std::move(*made);
}

TEST(LeftOutLights, PredictAMattClothExactly) {
  const Cloth cloth = {.normal = wave, .albedo = {0.2, 0.4, 0.8}};
  const Photographs counts = mosaics(kSize, cloth), rgb = developed(kSize, cloth);
  for (const char* name : {"least-squares", "fast", "standard", "robust"}) {
    const auto method = solver::find_method(name)->make();
    for (const Photographs* photographs : {&counts, &rgb}) {
      const solver::LeftOutError error = error_of_all(left_out(*photographs, {method.get()}));
      EXPECT_GT(error.readings, 2000U) << name;
      EXPECT_LT(error.median, 1e-4) << name;
    }
  }
}

TEST(LeftOutLights, MissByTheResidualOverTheFreedomWhereTheFitIsLinear) {
  const DistantLights lights = ten_lights();
  Photographs photographs = developed(kSize, {.normal = wave}, lights);
  Image<float>& third = std::get<Developed>(photographs.frames).rgb[2];
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) third(x, y, 0) = third(x, y, 1) = third(x, y, 2) += 0.1F;
  }
  const auto method = solver::least_squares_method();
  const LeftOut out = left_out(photographs, {method.get()});
  // Light 3 left out: the others fit exactly, so it is off by all that was added, which is r / (1 - h).
  for (std::size_t pixel = 0; pixel < out.scale.size(); ++pixel) {
    ASSERT_NEAR(out.error[pixel * 10 + 2], 0.1, 1e-5) << pixel;
  }
}

TEST(LeftOutLights, MissByWhatNoiseGivesAndNoMore) {
  Photographs photographs = mosaics(kSize, {.normal = wave});
  std::mt19937 random(5);
  for (RawFrame& frame : photographs.mosaics()->frames) {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        // Two electrons a count, three counts of read noise: what mosaics() says of its sensor.
        const double counts = frame.counts(x, y), sigma = std::sqrt((counts - kBlack) / 2 + 9);
        frame.counts(x, y) =
            static_cast<std::uint16_t>(std::lround(std::normal_distribution<double>(counts, sigma)(random)));
      }
    }
  }
  const auto method = solver::weighted_method();
  const LeftOut out = left_out(photographs, {method.get()});
  const solver::LeftOutError error = error_of_all(out);
  EXPECT_NEAR(error.rms / error.noise_rms, 1, 0.03);
  EXPECT_NEAR(error.median / error.noise_median, 1, 0.05);
}

TEST(LeftOutLights, KnowWhichGainsAreRight) {
  DistantLights lights = ten_lights();
  const std::vector<double> gains = {1, 1, 1, 1.05, 1, 1, 1, 0.97, 1, 1};
  for (std::size_t k = 0; k < 10; ++k) {
    for (double& channel : lights.lights[k].irradiance_rgb) channel *= gains[k];
  }
  Photographs photographs = developed(kSize, {.normal = wave}, lights);
  photographs.field = *LightField::make(ten_lights(), std::nullopt, kSize, 0);
  const auto method = solver::standard_method();
  const LeftOut without = left_out(photographs, {method.get()});
  const LeftOut with = left_out(photographs, {.method = method.get(), .gains = gains});
  EXPECT_TRUE(compare(without, with).frame.keeps());
  EXPECT_FALSE(compare(with, without).frame.keeps());
  EXPECT_LT(error_of_all(with).median, 1e-4);
  EXPECT_GT(error_of_all(without).median, 0.005);
}

TEST(LeftOutLights, AreTheSameForAnyNumberOfThreads) {
  const Photographs photographs = mosaics(kSize, {.normal = wave});
  const auto method = solver::robust_method();
  const LeftOut one = left_out(photographs, {method.get()}, 1),
                three = left_out(photographs, {method.get()}, 3);
  ASSERT_EQ(one.error.size(), three.error.size());
  EXPECT_EQ(std::memcmp(one.error.data(), three.error.data(), one.error.size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace weft::solve
