// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/cloth_spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace weft::solver {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Size kCells = {90, 50};
constexpr std::array<SeenAt, 3> kPlaces = {};

// Waves that a mirror at the border continues.
double wave(double x, double y, int across, int down) {
  return std::cos(kPi * across * (x + 0.5) / kCells.width) * std::cos(kPi * down * (y + 0.5) / kCells.height);
}

double share_that_stays(double mean_cells, int across, int down) {
  const double f = std::hypot(across / (2.0 * kCells.width), down / (2.0 * kCells.height));
  const double t = 4 * mean_cells * f;  // 2 pi l f
  return 1 / (1 + t * t);
}

TEST(ClothSpread, IsKnownOfEveryWaveOfLight) {
  for (const double mean_cells : {1.0, 3.0, 8.0}) {
    for (const double share : {0.1, 0.3, 0.6}) {
      constexpr int kAcross = 12, kDown = 5;
      const double k = share_that_stays(mean_cells, kAcross, kDown);
      Image<float> seen(kCells, 3);
      for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < kCells.height; ++y) {
          for (int x = 0; x < kCells.width; ++x)
            seen(x, y, c) = static_cast<float>(
                (c + 1) * (1 + 0.5 * (1 - share + share * k) * wave(x, y, kAcross, kDown)));
        }
      }
      const Image<float> beside = light_from_beside(seen, kPlaces, share, mean_cells, 1);
      double farthest = 0;
      for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < kCells.height; ++y) {
          for (int x = 0; x < kCells.width; ++x) {
            const double truth = (c + 1) * share * (1 + 0.5 * k * wave(x, y, kAcross, kDown));
            farthest = std::max(farthest, std::abs(static_cast<double>(beside(x, y, c)) - truth));
          }
        }
      }
      EXPECT_LT(farthest, 1e-3 * share) << share << " over " << mean_cells << " cells";
    }
  }
}

TEST(ClothSpread, GivesTheSameBytesByAnyNumberOfThreads) {
  Image<float> seen(kCells, 3);
  for (int y = 0; y < kCells.height; ++y) {
    for (int x = 0; x < kCells.width; ++x) seen(x, y, 1) = static_cast<float>((31 * x + 17 * y) % 23);
  }
  const Image<float> one = light_from_beside(seen, kPlaces, 0.4, 4, 1),
                     four = light_from_beside(seen, kPlaces, 0.4, 4, 4);
  for (int y = 0; y < kCells.height; ++y)
    ASSERT_TRUE(std::equal(one.plane(1).row(y), one.plane(1).row(y) + kCells.width, four.plane(1).row(y)));
}

TEST(ClothSpread, CellsAreEvenAndGrowWithTheDistance) {
  EXPECT_EQ(side_of_spread_cells(0.5, true), 2);
  EXPECT_EQ(side_of_spread_cells(7.5, true), 4);
  EXPECT_EQ(side_of_spread_cells(75, true) % 2, 0);
  EXPECT_NEAR(side_of_spread_cells(75, true), 75 * 2 / kPi / 1.5, 1.5);
  EXPECT_EQ(side_of_spread_cells(3, false), 1);
}

}  // namespace
}  // namespace weft::solver
