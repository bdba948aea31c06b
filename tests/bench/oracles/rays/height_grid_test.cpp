// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/height_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "tests/bench/oracles/rays/traced.h"

namespace weft::test {
namespace {

using namespace solver;

TEST(HeightGrid, RefusesBlocksOutsideThePicture) {
  const TestCloth cloth = bumpy_cloth({40, 30});
  const Relief relief = cloth.relief();
  for (const Rect block : {Rect{0, 0, 41, 30}, Rect{-1, 0, 5, 5}, Rect{5, 5, 5, 9}, Rect{9, 5, 5, 9}}) {
    const auto grid = HeightGrid::build(relief, block, 4);
    ASSERT_FALSE(grid) << block.x0 << ", " << block.x1;
    EXPECT_EQ(grid.error().kind, ErrorKind::kBadData);
  }
  EXPECT_FALSE(HeightGrid::build(relief, {0, 0, 4, 4}, -1));
  const auto grid = HeightGrid::build(relief, {10, 0, 20, 30}, 4);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->area(), (Rect{6, 0, 24, 30}));
}

TEST(HeightGrid, TracesTheActiveRaysOfAPacketWhateverTheOthersHold) {
  const TestCloth wall = cloth_over({40, 30}, [](int x, int) {
    return std::pair{x < 20 ? 0.0 : 8.0, Vec3{0, 0, 1}};
  });
  const HeightGrid grid = grid_of(wall, wall.pixels(), 0);
  RayPacket rays;
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  for (float* values : {rays.start_x, rays.start_y, rays.start_z, rays.direction_x, rays.direction_y,
                        rays.direction_z, rays.length}) {
    std::fill_n(values, kPacket, nothing);
  }
  std::fill_n(rays.is_active, kPacket, 0);
  const auto aim = [&](int lane, float towards_x) {
    rays.is_active[lane] = -1;
    rays.start_x[lane] = 10;
    rays.start_y[lane] = -15;
    rays.start_z[lane] = 1;
    rays.direction_x[lane] = towards_x;
    rays.direction_y[lane] = rays.direction_z[lane] = 0;
    rays.length[lane] = 25;
  };
  aim(3, 1);
  aim(12, -1);
  EXPECT_EQ(grid.occlude(rays), 1U << 3);
  std::array<float, kPacket> met = {};
  grid.intersect(rays, met.data());
  EXPECT_NEAR(met[3], 9.125, 1e-3);
  EXPECT_EQ(met[12], std::numeric_limits<float>::infinity());
}

TEST(HeightGrid, OfOneRowOrColumnHidesNothing) {
  for (const Size size : {Size{1, 1}, Size{1, 9}, Size{40, 1}}) {
    const TestCloth cloth = cloth_over(size, [](int x, int y) {
      return std::pair{5.0 * ((x + y) % 3), Vec3{0, 0, 1}};
    });
    const HeightGrid grid = grid_of(cloth, cloth.pixels(), 3);
    const auto bits = visible_in(grid, cloth, cloth.pixels(), near_lights(), 20);
    const auto openness = openness_in(grid, cloth, cloth.pixels(), {});
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        EXPECT_EQ(bits(x, y), 0x3ffU);
        EXPECT_EQ(openness(x, y), 1);
      }
    }
  }
}

TEST(HeightGrid, TakesUnder160BytesAPixelAndGivesThemBack) {
  const TestCloth cloth = bumpy_cloth({300, 200});
  const std::int64_t before = HeightGrid::bytes_in_use();
  {
    const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
    const double bytes = static_cast<double>(HeightGrid::bytes_in_use() - before);
    EXPECT_LT(bytes / (300 * 200), 160);
    EXPECT_GT(bytes / (300 * 200), 28) << "three floats and four corners at least";
  }
  EXPECT_EQ(HeightGrid::bytes_in_use(), before);
}

}  // namespace
}  // namespace weft::test
