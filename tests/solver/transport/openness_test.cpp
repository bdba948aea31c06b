// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/horizon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/bench/oracles/rays/traced.h"
#include "tests/solver/transport/cloths.h"

namespace weft::solver {
namespace {

Image<float> scanned_in(const TestCloth& cloth, Rect tile, const HorizonSettings& settings) {
  Image<float> openness({tile.width(), tile.height()});
  const auto done = scan_openness(cloth.relief(), tile, cloth.normals_of(tile), settings, openness.plane());
  EXPECT_TRUE(done) << (done ? "" : done.error().message());
  return openness;
}

double mean_of(const Image<float>& image, Rect part) {
  double sum = 0;
  for (int y = part.y0; y < part.y1; ++y) {
    for (int x = part.x0; x < part.x1; ++x) sum += static_cast<double>(image(x, y));
  }
  return sum / static_cast<double>(part.pixels());
}

TEST(HorizonScan, FindsAPlaneOpen) {
  for (const double slope : {0.0, 0.5}) {
    const TestCloth plane = cloth_over({80, 80}, [&](int x, int) {
      return std::pair{slope * x, normalized({-slope, 0, 1})};
    });
    const auto openness = scanned_in(plane, {20, 20, 60, 60}, {});
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) {
        EXPECT_NEAR(openness(x, y), 1, slope == 0 ? 1e-6 : 1e-3) << x << ", " << y << ", slope " << slope;
      }
    }
  }
}

// A wall without end hides (1 - cos(elevation of its edge)) / 2 of the sky from level ground.
TEST(HorizonScan, FindsWhatAWallHides) {
  constexpr int kEdge = 60;
  constexpr double kHeight = 12;
  const TestCloth step = cloth_over({140, 400}, [&](int x, int) {
    return std::pair{x <= kEdge ? kHeight : 0.0, Vec3{0, 0, 1}};
  });
  const test::HeightGrid grid = test::grid_of(step, step.pixels(), 0);
  const Rect tile = {64, 168, 96, 232};
  const auto scanned = scanned_in(step, tile, {.slices = 16, .steps = 64, .radius_px = 165});
  const auto traced = test::openness_in(grid, step, tile, {.rays = 256, .reach_px = 165});
  for (int x = tile.x0; x < tile.x1; ++x) {
    const double expected = (1 + std::cos(std::atan(kHeight / (x - kEdge)))) / 2;
    const Rect column = {x - tile.x0, 0, x - tile.x0 + 1, 64};
    EXPECT_NEAR(mean_of(scanned, column), expected, 0.02) << x;
    EXPECT_NEAR(mean_of(traced, column), expected, 0.006) << x;
  }
}

TEST(HorizonScan, FindsWhatTheOtherWallOfAGrooveHides) {
  const TestCloth cloth = groove({40, 512});
  const Rect tile = {20 - kGrooveHalf + 1, 240, 19, 272};
  const auto scanned = scanned_in(cloth, tile, {.slices = 16, .steps = 64, .radius_px = 230});
  for (int x = tile.x0; x < tile.x1; ++x) {
    const double expected = 1 - hidden_in_groove((20.0 - x) / kGrooveHalf);
    EXPECT_NEAR(mean_of(scanned, {x - tile.x0, 0, x - tile.x0 + 1, 32}), expected, 0.02) << x;
  }
}

TEST(HorizonScan, AgreesWithRaysOnAWeave) {
  const TestCloth cloth = bumpy_cloth({128, 128});
  const test::HeightGrid grid = test::grid_of(cloth, cloth.pixels(), 0);
  const Rect tile = {48, 48, 80, 80}, all = {0, 0, 32, 32};
  const double traced = mean_of(test::openness_in(grid, cloth, tile, {.rays = 64}), all);
  EXPECT_NEAR(mean_of(scanned_in(cloth, tile, {}), all), traced, 0.03);
  EXPECT_NEAR(mean_of(scanned_in(cloth, tile, {.slices = 8, .steps = 64}), all), traced, 0.01);
}

TEST(HorizonScan, RefusesWhatDoesNotFit) {
  const TestCloth cloth = bumpy_cloth({20, 20});
  Image<float> openness({20, 20});
  const auto is_done = [&](Rect tile, const HorizonSettings& settings) {
    return scan_openness(cloth.relief(), tile, cloth.normals_of(cloth.pixels()), settings, openness.plane())
        .has_value();
  };
  EXPECT_TRUE(is_done(cloth.pixels(), {}));
  EXPECT_FALSE(is_done({0, 0, 21, 20}, {}));
  EXPECT_FALSE(is_done({0, 0, 0, 20}, {}));
  EXPECT_FALSE(is_done(cloth.pixels(), {.slices = 0}));
  EXPECT_FALSE(is_done(cloth.pixels(), {.steps = 1000}));
  EXPECT_FALSE(is_done(cloth.pixels(), {.radius_px = 0}));
}

}  // namespace
}  // namespace weft::solver
