// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/ray_shadows.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/parallel.h"
#include "tests/bench/oracles/rays/traced.h"

namespace weft::test {
namespace {

using namespace solver;

TEST(CastShadows, LeaveAPlaneAllLit) {
  for (const double slope : {0.0, 0.7}) {
    const TestCloth plane = cloth_over({70, 40}, [&](int x, int) {
      return std::pair{slope * x, normalized({-slope, 0, 1})};
    });
    const HeightGrid grid = grid_of(plane, plane.pixels(), 0);
    const LightDirections lights =
        distant({direction_of(50, 0), direction_of(28, 90), direction_of(10, 180)});
    const auto bits = visible_in(grid, plane, plane.pixels(), lights, 200);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 70; ++x) ASSERT_EQ(bits(x, y), 0b111U) << x << ", " << y << ", slope " << slope;
    }
  }
}

// From the edge at column 20 a shadow falls on all columns whose ray passes below it. Edges to a fiftieth of
// a pixel on either side of a pixel's own.
TEST(CastShadows, EndWhereAStepPutsThem) {
  constexpr int kEdge = 20;
  for (const double elevation_deg : {28.0, 45.0, 60.0}) {
    const double tangent = std::tan(radians(elevation_deg));
    for (const double width_px : {6.98, 7.02, 11.5, 12.98, 13.02}) {
      const double height_px = width_px * tangent + static_cast<double>(HeightGrid::kLift);
      const TestCloth step = cloth_over({64, 3}, [&](int x, int) {
        return std::pair{x <= kEdge ? height_px : 0.0, Vec3{0, 0, 1}};
      });
      const HeightGrid grid = grid_of(step, step.pixels(), 0);
      const auto bits =
          visible_in(grid, step, step.pixels(), distant({direction_of(elevation_deg, 180)}), 40);
      for (int x = 0; x < 64; ++x) {
        const bool is_dark = x > kEdge && x - kEdge < width_px;
        EXPECT_EQ(bits(x, 1), is_dark ? 0U : 1U)
            << x << ", " << elevation_deg << " degrees, " << width_px << " wide";
      }
    }
  }
}

TEST(CastShadows, FallUpwardsInThePictureFromALightBelowIt) {
  const TestCloth step = cloth_over({3, 40}, [](int, int y) {
    return std::pair{y >= 20 ? 8.0 : 0.0, Vec3{0, 0, 1}};
  });
  const HeightGrid grid = grid_of(step, step.pixels(), 0);
  const auto bits =
      visible_in(grid, step, step.pixels(), distant({direction_of(45, -90), direction_of(45, 90)}), 40);
  for (int y = 0; y < 40; ++y) EXPECT_EQ(bits(1, y), y > 12 && y < 20 ? 0b10U : 0b11U) << y;
}

TEST(CastShadows, CountAttachedShadowsAsUnseen) {
  TestCloth plane = cloth_over({20, 1}, [](int, int) { return std::pair{0.0, Vec3{0, 0, 1}}; });
  const Vec3 light = direction_of(30, 0);
  const auto set = [&](int x, Vec3 n) {
    plane.normal(x, 0, 0) = static_cast<float>(n.x);
    plane.normal(x, 0, 2) = static_cast<float>(n.z);
  };
  set(3, direction_of(119, 0));
  set(4, direction_of(121, 0));
  set(5, {std::numeric_limits<double>::quiet_NaN(), 0, 1});
  set(6, {0, 0, 0});
  const HeightGrid grid = grid_of(plane, plane.pixels(), 0);
  const auto bits = visible_in(grid, plane, plane.pixels(), distant({light}), 10);
  for (int x = 0; x < 20; ++x) EXPECT_EQ(bits(x, 0), x >= 4 && x <= 6 ? 0U : 1U) << x;
}

TEST(CastShadows, HaveABitForEachOfManyLights) {
  const TestCloth cloth = bumpy_cloth({40, 12});
  const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
  std::vector<Vec3> directions;
  for (int k = 0; k < 70; ++k) directions.push_back(direction_of(15 + k, 37.0 * k));
  const auto all = visible_in(grid, cloth, cloth.pixels(), distant(directions), 60);
  ASSERT_EQ(all.planes(), 3);
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const auto alone = visible_in(grid, cloth, cloth.pixels(), distant({directions[k]}), 60);
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 40; ++x) {
        ASSERT_EQ((all(x, y, static_cast<int>(k / 32)) >> (k % 32)) & 1U, alone(x, y)) << k;
      }
    }
  }
  for (int x = 0; x < 40; ++x) EXPECT_EQ(all(x, 5, 2) >> 6, 0U) << "bits of no light";
}

TEST(CastShadows, AreTheSameBytesFromBlocksAndTilesOfAnySize) {
  const TestCloth cloth = bumpy_cloth({150, 90});
  const LightDirections lights = near_lights();
  const int reach_px = shadow_reach(cloth.relief(), lights).reach_px;
  const auto expected =
      visible_in(grid_of(cloth, cloth.pixels(), 0), cloth, cloth.pixels(), lights, reach_px);
  int shadowed = 0;
  for (const Rect block :
       {Rect{0, 0, 64, 90}, Rect{64, 0, 150, 33}, Rect{70, 41, 93, 55}, Rect{149, 89, 150, 90}}) {
    const HeightGrid grid = grid_of(cloth, block, reach_px + 1);
    const Rect part = {block.x0 + block.width() / 3, block.y0 + block.height() / 4, block.x1, block.y1};
    for (const Rect tile : {block, part}) {
      const auto bits = visible_in(grid, cloth, tile, lights, reach_px);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          ASSERT_EQ(bits(x - tile.x0, y - tile.y0), expected(x, y)) << x << ", " << y;
          shadowed += 10 - std::popcount(expected(x, y));
        }
      }
    }
  }
  EXPECT_GT(shadowed, 10000);
}

TEST(CastShadows, AreTheSameBytesFromManyThreads) {
  const TestCloth cloth = bumpy_cloth({128, 64});
  const LightDirections lights = near_lights();
  const auto run = [&](int threads) {
    std::vector<std::uint32_t> bits(128 * 64, ~0U);
    parallel_for(16, threads, [&](std::size_t i, int) {
      const int x0 = static_cast<int>(i % 4) * 32, y0 = static_cast<int>(i / 4) * 16;
      const Rect block = {x0, y0, x0 + 32, y0 + 16};
      const auto grid = HeightGrid::build(cloth.relief(), block, 21);
      const View<std::uint32_t> plane(&bits[static_cast<std::size_t>(y0 * 128 + x0)], {32, 16}, 128);
      ASSERT_TRUE(grid &&
                  find_visible_lights(*grid, block, cloth.normals_of(block), lights, 20, {&plane, 1}));
    });
    return bits;
  };
  EXPECT_EQ(run(1), run(4));
}

TEST(CastShadows, ComeFromNoFartherThanTheReach) {
  const TestCloth step = cloth_over({30, 3}, [](int x, int) {
    return std::pair{x < 3 ? 10.0 : 0.0, Vec3{0, 0, 1}};
  });
  const HeightGrid grid = grid_of(step, step.pixels(), 0);
  const auto bits = visible_in(grid, step, step.pixels(), distant({direction_of(28, 180)}), 8);
  for (int x = 4; x < 30; ++x) EXPECT_EQ(bits(x, 1), x <= 10 ? 0U : 1U) << x;
}

TEST(CastShadows, RefuseWhatDoesNotFit) {
  const TestCloth cloth = bumpy_cloth({100, 20});
  const Rect block = {40, 0, 60, 20};
  const HeightGrid grid = grid_of(cloth, block, 11);
  Image<std::uint32_t> bits({20, 20}, 2);
  const auto planes = planes_of(bits);
  const auto why = [&](Rect tile, const LightDirections& lights, int reach_px, std::size_t words) {
    const auto done = find_visible_lights(grid, tile, cloth.normals_of(block), lights, reach_px,
                                          std::span(planes).first(words));
    return done ? "done" : done.error().remedy;
  };
  EXPECT_EQ(why(block, near_lights(), 10, 1), "done");
  EXPECT_EQ(why(block, near_lights(), 11, 1), "build the block with a halo of 12 pixels");
  EXPECT_EQ(why({39, 0, 50, 20}, near_lights(), 10, 1), "ask for a tile inside the block");
  EXPECT_EQ(why({50, 0, 50, 20}, near_lights(), 10, 1), "ask for a tile inside the block");
  EXPECT_EQ(why(block, near_lights(), 0, 1), "give a reach of at least 1 pixel");
  EXPECT_EQ(why(block, near_lights(), 10, 2), "give 1 planes of the tile's size");
  EXPECT_EQ(why(block, {}, 10, 0), "give the direction to at least one light");
}

}  // namespace
}  // namespace weft::test
