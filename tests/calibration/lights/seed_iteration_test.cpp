// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/seed_iteration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/oracles/paper_oracle.h"

namespace weft::calibration {
namespace {

constexpr int kSeedColumns = 26, kSeedRows = 17;

struct SeedTrial {
  SeedLights lights;
  std::vector<double> error_deg;  // rms angle to the true directions, at the start and at the end
};

SeedTrial run(const SeedOptions& options) {
  test::PaperRig rig = test::common_rig();
  rig.sheets = test::lies(1);
  const auto captures = test::captures_of(rig, {.noise = 0.002}, kSeedColumns, kSeedRows);
  const CellGrid grid = {captures.start.camera.size, kSeedColumns, kSeedRows};
  SeedTrial result;
  for (const int iterations : {0, options.iterations}) {
    SeedOptions some = options;
    some.iterations = iterations;
    auto lights = iterate_seed(captures.start, captures.readings, grid, some);
    EXPECT_TRUE(lights) << lights.error().message();
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < lights->maps.size(); ++k) {
      for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
        const auto [x, y] = grid.centre_px(cell);
        const Vec3 truth = rig.lights.leds[k].position_mm - point_on_plane(captures.start.camera, x, y, 0);
        sum += std::pow(angle_deg(lights->maps[k].direction[cell], truth), 2);
        ++count;
      }
    }
    result.error_deg.push_back(std::sqrt(sum / count));
    result.lights = std::move(*lights);
  }
  return result;
}

TEST(SeedIteration, LeavesDirectionsAsTheyAreWhereNothingIsFiltered) {
  const SeedTrial done = run({.iterations = 5, .filter_cells = 0});
  ASSERT_EQ(done.lights.steps.size(), 6u);
  for (const SeedStep& step : done.lights.steps) {
    EXPECT_LT(step.direction_change_deg, 1e-5) << "every start is a fixed point";
    EXPECT_LT(step.paper_residual_deg, 1e-5) << "and the paper is flat under each";
  }
  EXPECT_GT(done.error_deg[0], 0.5) << "although directions are wrong by what the tape was";
  EXPECT_NEAR(done.error_deg[1] / done.error_deg[0], 1, 0.01);
}

TEST(SeedIteration, MakesThePaperFlatterAndDirectionsNoBetter) {
  const SeedTrial done = run({.iterations = 5, .filter_cells = 1});
  const auto& steps = done.lights.steps;
  EXPECT_LT(steps.back().paper_residual_deg, 0.8 * steps.front().paper_residual_deg);
  EXPECT_GT(steps.back().direction_change_deg, 0);
  EXPECT_GT(done.error_deg[1], 0.99 * done.error_deg[0]);
}

TEST(SeedIteration, NeedsThreeLeds) {
  test::PaperRig rig = test::common_rig();
  rig.sheets = test::lies(1);
  rig.lights.leds.resize(2);
  const auto captures = test::captures_of(rig, {}, 5, 4);
  const auto lights = iterate_seed(captures.start, captures.readings, {captures.start.camera.size, 5, 4});
  ASSERT_FALSE(lights);
  EXPECT_NE(lights.error().message().find("three LEDs"), std::string::npos);
}

}  // namespace
}  // namespace weft::calibration
