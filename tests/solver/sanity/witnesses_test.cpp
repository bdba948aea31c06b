// SPDX-License-Identifier: Apache-2.0
#include "solver/sanity/witnesses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

namespace weft::solver {
namespace {

constexpr int kSide = 32;

// A ring of lights and one ring above it, none of them symmetric to another.
std::vector<Vec3> ring(std::size_t count) {
  std::vector<Vec3> lights;
  for (std::size_t k = 0; k < count; ++k) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count) + 0.3;
    const double height = k % 2 == 0 ? 0.9 : 1.6;
    lights.push_back(normalized({std::cos(turn), std::sin(turn), height}));
  }
  return lights;
}

// Matt cloth of a height in closed form, 0.3 sin(x/5 + y/7) + 0.2 cos(x/3 - y/4), seen through `curve`.
BlockTile cloth_under(
    const std::vector<Vec3>& lights,
    const std::function<double(double)>& curve = [](double v) { return v; }) {
  BlockTile tile = {kSide, kSide, lights, {}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double a = x / 5.0 + y / 7.0, b = x / 3.0 - y / 4.0;
      const double dx = 0.3 * std::cos(a) / 5 - 0.2 * std::sin(b) / 3;
      const double down = 0.3 * std::cos(a) / 7 + 0.2 * std::sin(b) / 4;
      const Vec3 normal = normalized({-dx, down, 1});
      const double albedo = 0.4 + 0.1 * std::sin(x / 2.0);
      for (const Vec3& light : lights)
        tile.readings.push_back(static_cast<float>(curve(albedo * std::max(dot(normal, light), 0.0))));
    }
  }
  return tile;
}

// The lights as somebody writes them down who means other axes.
BlockTile with_lights(BlockTile tile, const std::function<Vec3(Vec3)>& as) {
  for (Vec3& light : tile.lights) light = as(light);
  return tile;
}

TEST(SanityWitnesses, LeftOutLightIsPredictedExactlyWhereAllIsAsItIsTakenFor) {
  const std::vector<BlockTile> tiles = {cloth_under(ring(10))};
  EXPECT_LT(left_out_error(tiles), 1e-6);
  EXPECT_LT(std::abs(constant_share(tiles)), 1e-5);
}

TEST(SanityWitnesses, TheCurlOfTheSlopesTellsWhichAxesLightsMean) {
  const BlockTile cloth = cloth_under(ring(10));
  const struct {
    const char* says;
    std::function<Vec3(Vec3)> as;
    Symmetry meant;
  } cases[] = {{"as given", [](Vec3 v) { return v; }, Symmetry::kAsGiven},
               {"half a turn",
                [](Vec3 v) {
                  return Vec3{-v.x, -v.y, v.z};
                },
                Symmetry::kAsGiven},
               {"y down",
                [](Vec3 v) {
                  return Vec3{v.x, -v.y, v.z};
                },
                Symmetry::kMirrored},
               {"x to the left",
                [](Vec3 v) {
                  return Vec3{-v.x, v.y, v.z};
                },
                Symmetry::kMirrored},
               {"a quarter",
                [](Vec3 v) {
                  return Vec3{-v.y, v.x, v.z};
                },
                Symmetry::kQuarterTurned},
               {"the other quarter",
                [](Vec3 v) {
                  return Vec3{v.y, -v.x, v.z};
                },
                Symmetry::kQuarterTurned},
               {"exchanged",
                [](Vec3 v) {
                  return Vec3{v.y, v.x, v.z};
                },
                Symmetry::kExchanged}};
  for (const auto& c : cases) {
    const std::vector<BlockTile> tiles = {with_lights(cloth, c.as)};
    const auto found = curls(tiles);
    for (std::size_t s = 0; s < kSymmetries; ++s) {
      if (s == static_cast<std::size_t>(c.meant)) continue;
      EXPECT_GT(found[s], 5 * found[static_cast<std::size_t>(c.meant)]) << c.says << ", symmetry " << s;
    }
  }
}

TEST(SanityWitnesses, TheRightCurvePredictsLeftOutLightBetter) {
  const auto square = [](double v) { return v * v; };
  const auto root = [](double v) { return std::sqrt(v); };
  const std::vector<BlockTile> coded = {cloth_under(ring(10), root)};
  EXPECT_LT(left_out_error_through(coded, square), 1e-6);
  EXPECT_GT(left_out_error(coded), 0.01);
}

TEST(SanityWitnesses, AConstantLightIsFoundByItsShare) {
  const std::vector<BlockTile> tiles = {cloth_under(ring(10), [](double v) { return v + 0.02; })};
  double mean = 0;
  for (const float reading : tiles[0].readings) mean += static_cast<double>(reading);
  mean /= static_cast<double>(tiles[0].readings.size());
  EXPECT_NEAR(constant_share(tiles), 0.02 / mean, 0.1 * 0.02 / mean);
  EXPECT_GT(left_out_error(tiles), 100 * left_out_error(tiles, true));
}

TEST(SanityWitnesses, ListedInTheOrderOfTextTwelvePhotographsFitBetterAsPeopleCount) {
  const BlockTile cloth = cloth_under(ring(12));
  const std::vector<std::size_t> text = {0, 9, 10, 11, 1, 2, 3, 4, 5, 6, 7, 8};  // 1, 10, 11, 12, 2 ...
  BlockTile listed = cloth;
  for (std::size_t block = 0; block < static_cast<std::size_t>(kSide * kSide); ++block) {
    for (std::size_t k = 0; k < 12; ++k)
      listed.readings[block * 12 + k] = cloth.readings[block * 12 + text[k]];
  }
  const std::vector<BlockTile> tiles = {listed};
  EXPECT_GT(left_out_error(tiles), 0.05);
  EXPECT_LT(left_out_error_in_order(tiles, text), 1e-6);
}

TEST(SanityWitnesses, ThreeLightsAndBlocksWithoutReadingsTellNothing) {
  std::vector<BlockTile> tiles = {cloth_under(ring(3))};
  EXPECT_TRUE(std::isinf(left_out_error(tiles)));
  tiles = {cloth_under(ring(10))};
  std::ranges::fill(tiles[0].readings, std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(std::isinf(left_out_error(tiles)));
  EXPECT_TRUE(std::isnan(curls(tiles)[0]));
  EXPECT_TRUE(std::isnan(constant_share(tiles)));
}

}  // namespace
}  // namespace weft::solver
