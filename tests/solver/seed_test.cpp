// SPDX-License-Identifier: Apache-2.0
#include "solver/normals/seed.h"

#include <gtest/gtest.h>

#include <limits>

#include "bench/oracles/oracle_rig.h"
#include "tests/solver/tiles.h"

namespace weft {
namespace {

std::vector<solver::PixelRow> rows_of(const LightField& field, int x, int y, Vec3 normal,
                                      std::array<double, 3> albedo) {
  std::vector<solver::PixelRow> rows;
  for (std::size_t k = 0; k < field.count(); ++k) {
    solver::PixelRow row;
    for (std::size_t c = 0; c < 3; ++c) {
      const LightField::Light light = field.at(k, static_cast<int>(c), x, y);
      row.direction = light.direction;
      row.strength[c] = light.strength;
      row.reading[c] = albedo[c] * light.strength * dot(normal, light.direction);
    }
    rows.push_back(row);
  }
  return rows;
}

LightField field() {
  return *LightField::make(test::ten_leds(), overhead_camera(test::kClothSize, 600, 0.3), test::kClothSize,
                           0);
}

TEST(SeedMethod, RecoversATiltedPlaneInDouble) {
  const LightField lights = field();
  const Vec3 n = normalized({0.2, -0.1, 1});
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(320, 240), std::pair(639, 479)}) {
    const solver::SeedPixel pixel = solver::solve_seed_pixel(rows_of(lights, x, y, n, {0.2, 0.4, 0.1}));
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_TRUE(pixel.solved[i]);
      EXPECT_LT(angle_deg(pixel.n[i], n), 1e-11) << "system " << i << " at " << x << ", " << y;
    }
    EXPECT_NEAR(length(pixel.n[0]), 0.2, 1e-13);
    EXPECT_NEAR(length(pixel.n[1]), 0.4, 1e-13);
    EXPECT_NEAR(length(pixel.n[2]), 0.1, 1e-13);
    EXPECT_NEAR(length(pixel.n[3]), 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.1, 1e-13);
  }
}

TEST(SeedMethod, LeavesASaturatedChannelOutOfItsOwnSystemAndOfLuminance) {
  const LightField lights = field();
  const Vec3 n = {0, 0, 1};
  std::vector<solver::PixelRow> rows = rows_of(lights, 100, 100, n, {0.2, 0.4, 0.1});
  rows[3].reading[1] = std::numeric_limits<double>::infinity();
  rows[7].reading[0] = std::numeric_limits<double>::quiet_NaN();
  const solver::SeedPixel pixel = solver::solve_seed_pixel(rows);
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_TRUE(pixel.solved[i]) << i;
    EXPECT_LT(angle_deg(pixel.n[i], n), 1e-11) << i;
  }
}

TEST(SeedMethod, HasNoSolutionFromTwoLights) {
  const LightField lights = field();
  std::vector<solver::PixelRow> rows = rows_of(lights, 100, 100, {0, 0, 1}, {0.2, 0.4, 0.1});
  rows.resize(2);
  for (const bool solved : solver::solve_seed_pixel(rows).solved) EXPECT_FALSE(solved);
}

}  // namespace
}  // namespace weft
