// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/light_assignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/capture/scan/simulated_rig.h"

namespace weft::capture {
namespace {

using Leds = std::vector<int>;

TEST(LeastCostColumns, FindsWhatTryingAllFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> cost_of(0, 10);
  for (int round = 0; round < 50; ++round) {
    constexpr std::size_t kRows = 4, kColumns = 6;
    std::vector<std::vector<double>> cost(kRows, std::vector<double>(kColumns));
    for (auto& row : cost)
      for (double& each : row) each = cost_of(random);
    const auto sum_of = [&](const std::vector<std::size_t>& columns) {
      double sum = 0;
      for (std::size_t row = 0; row < kRows; ++row) sum += cost[row][columns[row]];
      return sum;
    };
    std::vector<std::size_t> columns(kColumns);
    std::iota(columns.begin(), columns.end(), std::size_t{0});
    double least = 1e9;
    do {
      least = std::min(least, sum_of(columns));
    } while (std::next_permutation(columns.begin(), columns.end()));
    const std::vector<std::size_t> found = least_cost_columns(cost);
    ASSERT_EQ(found.size(), kRows);
    EXPECT_NEAR(sum_of(found), least, 1e-9);
  }
}

/// Patches of bumpy cloth with an albedo each, under lights by patch.
std::vector<std::vector<double>> light_on_bumps(const PatchLights& model, const Leds& leds, double noise) {
  std::mt19937 random(3);
  std::normal_distribution<double> deviate;
  std::vector<std::vector<double>> light(leds.size());
  for (int i = 0; i < model.grid.count(); ++i) {
    const Vec3 normal = normalized({0.2 * std::sin(1.3 * i), 0.2 * std::cos(2.1 * i), 1});
    const double albedo = 0.1 + 0.05 * std::sin(0.7 * i);
    for (std::size_t f = 0; f < leds.size(); ++f) {
      const Vec3 incident = model.leds[static_cast<std::size_t>(leds[f] - 1)][static_cast<std::size_t>(i)];
      light[f].push_back(albedo * std::max(0.0, dot(normal, incident)) * (1 + noise * deviate(random)));
    }
  }
  return light;
}

PatchLights rig_model() {
  Result<PatchLights> model = PatchLights::make(test::SimulatedCloth(test::small_scene()).calibration(), 0);
  EXPECT_TRUE(model) << model.error().message();
  return *std::move(model);
}

TEST(LightAssignment, FindsTheLedsOfShuffledFrames) {
  const PatchLights model = rig_model();
  Leds leds(model.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  std::mt19937 random(11);
  for (int round = 0; round < 5; ++round) {
    std::shuffle(leds.begin(), leds.end(), random);
    const auto found = assign_by_light(light_on_bumps(model, leds, 0.005), model, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->leds, leds) << "misfit " << found->misfit;
    EXPECT_TRUE(found->is_alone()) << found->misfit << " and " << found->second_misfit;
    EXPECT_GT(*std::min_element(found->sure.begin(), found->sure.end()), 1.6);
  }
}

TEST(LightAssignment, FindsTheLedsWhereSomeAreMissing) {
  const PatchLights model = rig_model();
  const Leds leds = {9, 2, 7, 1, 4, 10, 6};
  const auto found = assign_by_light(light_on_bumps(model, leds, 0.005), model, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->leds, leds);
  EXPECT_TRUE(found->is_alone()) << found->misfit << " and " << found->second_misfit;
}

TEST(LightAssignment, SaysThatARingOfDistantLightsCanBeTurned) {
  PatchLights ring;
  ring.grid = PatchGrid::over({320, 240});
  for (int k = 0; k < 8; ++k) {
    const double azimuth = radians(45.0 * k);
    const Vec3 direction = normalized({std::cos(azimuth), std::sin(azimuth), 1});
    ring.leds.emplace_back(static_cast<std::size_t>(ring.grid.count()), direction);
  }
  const Leds leds = {1, 2, 3, 4, 5, 6, 7, 8};
  const auto found = assign_by_light(light_on_bumps(ring, leds, 0.002), ring, {leds});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->is_alone()) << found->misfit << " and " << found->second_misfit;
  EXPECT_NEAR(found->second_misfit, found->misfit, 0.001);
}

TEST(LightAssignment, SaysNothingOfFourFramesAndOfMoreThanThereAreLeds) {
  const PatchLights model = rig_model();
  EXPECT_FALSE(assign_by_light(light_on_bumps(model, {1, 2, 3, 4}, 0), model, {}));
  EXPECT_FALSE(assign_by_light(light_on_bumps(model, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1}, 0), model, {}));
  EXPECT_FALSE(assign_by_light(
      std::vector<std::vector<double>>(6, std::vector<double>(static_cast<std::size_t>(model.grid.count()))),
      model, {}))
      << "there is no light";
}

}  // namespace
}  // namespace weft::capture
