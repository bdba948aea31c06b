// SPDX-License-Identifier: Apache-2.0
#include "solver/sanity/witnesses.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "solver/sanity/surface_witnesses.h"

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
  BlockTile tile;
  tile.width = tile.height = kSide;
  tile.count = lights.size();
  tile.lights = lights;
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
  EXPECT_LT(std::abs(constant_share(tiles).median), 1e-5);
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
  EXPECT_LT(left_out_error(coded, {.curve = square}), 1e-6);
  EXPECT_GT(left_out_error(coded), 0.01);
}

TEST(SanityWitnesses, AConstantLightIsFoundByItsShare) {
  const std::vector<BlockTile> tiles = {cloth_under(ring(10), [](double v) { return v + 0.02; })};
  double mean = 0;
  for (const float reading : tiles[0].readings) mean += static_cast<double>(reading);
  mean /= static_cast<double>(tiles[0].readings.size());
  EXPECT_NEAR(constant_share(tiles).median, 0.02 / mean, 0.1 * 0.02 / mean);
  EXPECT_GT(left_out_error(tiles), 100 * left_out_error(tiles, {.has_constant = true}));
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
  EXPECT_LT(left_out_error(tiles, {.order = text}), 1e-6);
}

TEST(SanityWitnesses, ExposuresByTurnsAreFoundThoughHalfOfThePhotographsHaveThem) {
  BlockTile cloth = cloth_under(ring(12));
  for (std::size_t i = 0; i < cloth.readings.size(); ++i) {
    if (i % 2 == 1) cloth.readings[i] /= 2;
  }
  const std::vector<BlockTile> tiles = {cloth};
  const std::vector<double> gains = gains_of(tiles, true);
  ASSERT_EQ(gains.size(), 12U);
  for (std::size_t k = 1; k < 12; k += 2) EXPECT_NEAR(gains[k] / gains[k - 1], 0.5, 0.01) << k;
  EXPECT_LT(left_out_error(evened_out(tiles, gains)), 0.02 * left_out_error(tiles));
}

TEST(SanityWitnesses, LampsThatAreNearAreFoundAtTheirDistance) {
  constexpr double kDistance = 60;  // blocks; the tile is 32 wide
  BlockTile cloth = cloth_under(ring(10));
  cloth.left = -0.5 * (kSide - 1), cloth.top = 0.5 * (kSide - 1);
  const double albedo = 0.5;
  for (std::size_t block = 0; block < cloth.blocks(); ++block) {
    const double a = static_cast<double>(block % kSide) / 5;
    const Vec3 normal = normalized({-0.06 * std::cos(a), 0, 1});
    const Vec3 place = {cloth.left + static_cast<double>(block % kSide),
                        cloth.top - static_cast<double>(block / kSide), 0};
    for (std::size_t k = 0; k < cloth.count; ++k) {
      const Vec3 way = kDistance * cloth.lights[k] - place;
      cloth.of(block)[k] =
          static_cast<float>(albedo * dot(normal, normalized(way)) * std::pow(kDistance / length(way), 2));
    }
  }
  const std::vector<BlockTile> tiles = {cloth};
  const double near = left_out_error(tiles, {.distance = kDistance});
  EXPECT_LT(near, 1e-5);
  for (const double other : {0.0, 0.7 * kDistance, 1.4 * kDistance})
    EXPECT_GT(left_out_error(tiles, {.distance = other}), 100 * near) << other;
}

TEST(SanityWitnesses, ShadowsAndHighlightsAreLeftOut) {
  std::vector<Vec3> lights = ring(24);
  lights[5] = normalized({0.1, 0.1, 1});  // so high that it shines
  BlockTile cloth = cloth_under(lights);
  for (std::size_t block = 0; block < cloth.blocks(); ++block) {
    cloth.of(block)[5] *= 1.5F;
    if (block % 24 != 5) cloth.of(block)[block % 24] = 0;  // in shadow
  }
  EXPECT_GT(left_out_error(std::vector<BlockTile>{cloth}), 0.1);
  const std::vector<BlockTile> lit = without_shadows({cloth});
  EXPECT_GT(left_out_error(lit), 0.02);
  EXPECT_LT(left_out_error(without_highlights(lit)), 1e-5);
}

// A ball of 12 blocks' radius in the middle of nothing.
BlockTile ball_under(const std::vector<Vec3>& lights) {
  BlockTile tile;
  tile.width = tile.height = kSide;
  tile.count = lights.size();
  tile.lights = lights;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double dx = (x - 15.5) / 12, up = (15.5 - y) / 12, square = 1 - dx * dx - up * up;
      for (const Vec3& light : lights)
        tile.readings.push_back(
            square < 0.2 ? std::numeric_limits<float>::quiet_NaN()
                         : static_cast<float>(std::max(0.0, dot({dx, up, std::sqrt(square)}, light))));
    }
  }
  return tile;
}

TEST(SanityWitnesses, AThingFallsAwayAtItsEdgeUnlessLightsAreTurnedByHalf) {
  const BlockTile ball = ball_under(ring(10));
  const auto half = [](Vec3 v) { return Vec3{-v.x, -v.y, v.z}; };
  EXPECT_GT(falls_at_edge(std::vector<BlockTile>{ball}), 0.9);
  EXPECT_LT(falls_at_edge(std::vector<BlockTile>{with_lights(ball, half)}), -0.9);
  EXPECT_TRUE(std::isnan(falls_at_edge(std::vector<BlockTile>{cloth_under(ring(10))})));
}

TEST(SanityWitnesses, HeightsAreThoseOfTheBall) {
  const BlockTile ball = ball_under(ring(10));
  const std::vector<double> heights = heights_of(ball);
  const auto at = [&](int x, int y) { return heights[static_cast<std::size_t>(y * kSide + x)]; };
  const auto truth = [](int x, int y) {
    return std::sqrt(144 - (x - 15.5) * (x - 15.5) - (15.5 - y) * (15.5 - y));
  };
  for (const auto& [x, y] : {std::pair{8, 15}, {15, 8}, {22, 16}, {20, 20}})
    EXPECT_NEAR(at(x, y) - at(15, 15), truth(x, y) - truth(15, 15), 0.15) << x << ' ' << y;
}

// Walls 4 blocks high every 16 blocks, whose shadows are those of a light from the left and one from the
// right.
TEST(SanityWitnesses, CastShadowsTellWhichWayRoundReliefIs) {
  std::vector<Vec3> lights = ring(10);
  BlockTile cloth;
  cloth.width = 64, cloth.height = kSide, cloth.count = 10, cloth.lights = lights;
  const auto height = [](double x) { return 3 * std::cos(x / 2.5); };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Vec3 normal = normalized({3 / 2.5 * std::sin(x / 2.5), 0, 1});
      for (const Vec3& light : lights) {
        bool shaded = false;
        for (int s = 1; s < 16; ++s) shaded = shaded || height(x + s * light.x) - height(x) > s * light.z;
        cloth.readings.push_back(shaded ? 0.0F : static_cast<float>(std::max(0.0, dot(normal, light))));
      }
    }
  }
  const Sides right = shadows_explained(std::vector<BlockTile>{cloth});
  const auto half = [](Vec3 v) { return Vec3{-v.x, -v.y, v.z}; };
  const Sides wrong = shadows_explained(std::vector<BlockTile>{with_lights(cloth, half)});
  EXPECT_GT(right.dark, 100U);
  EXPECT_GT(right.as_given, 0.3);
  EXPECT_GT(right.as_given, 4 * right.inside_out);
  EXPECT_NEAR(wrong.inside_out, right.as_given, 0.02);
  EXPECT_NEAR(wrong.as_given, right.inside_out, 0.02);
}

TEST(SanityWitnesses, ThreeLightsAndBlocksWithoutReadingsTellNothing) {
  std::vector<BlockTile> tiles = {cloth_under(ring(3))};
  EXPECT_TRUE(std::isinf(left_out_error(tiles)));
  tiles = {cloth_under(ring(10))};
  std::ranges::fill(tiles[0].readings, std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(std::isinf(left_out_error(tiles)));
  EXPECT_TRUE(std::isnan(curls(tiles)[0]));
  EXPECT_TRUE(std::isnan(constant_share(tiles).median));
}

}  // namespace
}  // namespace weft::solver
