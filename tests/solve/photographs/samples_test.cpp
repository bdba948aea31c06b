// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/samples.h"

#include <gtest/gtest.h>

#include "solver/sample_tiles.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kSampledSize = {300, 140};  // two sample tiles beside each other

TEST(Samples, AreWhatAMethodMakesOfTheSampleTiles) {
  const Cloth cloth = {.normal = wave, .albedo = {0.2, 0.4, 0.8}};
  const Photographs counts = mosaics(kSampledSize, cloth), rgb = developed(kSampledSize, cloth);
  for (const Photographs* photographs : {&counts, &rgb}) {
    const std::vector<SampleMaps> samples = solve_samples(*photographs, *solver::fast_method(), 2);
    const std::vector<Rect> tiles = solver::sample_tiles(kSampledSize);
    ASSERT_EQ(samples.size(), tiles.size());
    ASSERT_EQ(samples.size(), 2U);
    const Planes planes = photographs->planes();
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(samples[i].tile, tiles[i]);
      const int x = tiles[i].x0 + 31, y = tiles[i].y0 + 20;
      const Vec3 normal = {samples[i].normal(31, 20, 0), samples[i].normal(31, 20, 1),
                           samples[i].normal(31, 20, 2)};
      EXPECT_LT(angle_deg(normal, wave(x, y)), 0.01);
      const auto channel = static_cast<std::size_t>(planes.channel_at(planes.speaker(), x, y));
      EXPECT_NEAR(samples[i].albedo(31, 20), cloth.albedo[channel], 1e-4) << "the photosite's own, or green";
    }
  }
}

TEST(Samples, CountTheReadingsThatAreDarkBesideTheOthersOfTheirPixel) {
  const auto shadowed_share = [](double slope_deg) {
    const Cloth tilted = {.normal = [=](int, int) {
      return Vec3{std::sin(radians(slope_deg)), 0, std::cos(radians(slope_deg))};
    }};
    const std::vector<SampleMaps> samples =
        solve_samples(mosaics({64, 64}, tilted), *solver::fast_method(), 1);
    const SampleMaps& sample = samples.front();
    EXPECT_EQ(sample.readings, 64 * 64 * 10);
    return static_cast<double>(sample.shadowed) / static_cast<double>(sample.readings);
  };
  EXPECT_EQ(shadowed_share(0), 0);
  EXPECT_EQ(shadowed_share(30), 0.1) << "the light straight behind, at 62 degrees, is below the horizon";
}

TEST(Samples, OpenTheGateOfSlopesForASteepClothAlone) {
  const auto gates_of = [](const Cloth& cloth) {
    const Photographs photographs = mosaics({128, 128}, cloth);
    return *measure_gates(solve_samples(photographs, *solver::standard_method(), 2), photographs);
  };
  EXPECT_FALSE(gates_of({}).slope.is_over);
  const auto steep = [](int x, int) {
    return normalized({std::tan(radians(30)) * (x % 24 < 12 ? 1 : -1), 0, 1});
  };
  const solver::Gates gates = gates_of({.normal = steep});
  EXPECT_NEAR(gates.slope.value, 30, 0.01);
  EXPECT_TRUE(gates.slope.is_over);
}

}  // namespace
}  // namespace weft::solve
