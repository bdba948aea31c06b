// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace weft::solver {
namespace {

TEST(Lattice, HasAllItsPointsAndACellOfTheirShare) {
  for (const int points : {1, 2, 3, 5, 8, 32, 100, 128, 1000, 4096}) {
    const Lattice lattice = make_lattice(points);
    ASSERT_EQ(lattice.points.size(), static_cast<std::size_t>(points));
    std::set<std::pair<float, float>> distinct;
    for (const TorusPoint& p : lattice.points) {
      ASSERT_TRUE(p.u >= 0 && p.u < 1 && p.v >= 0 && p.v < 1) << p.u << ", " << p.v;
      distinct.insert({p.u, p.v});
    }
    EXPECT_EQ(distinct.size(), lattice.points.size());
    const auto& [a, b] = lattice.cell;
    EXPECT_NEAR(std::abs(a.u * b.v - a.v * b.u) * static_cast<float>(points), 1, 1e-3) << points;
  }
}

// Over the lattice and many pixels' shifts, every box of a partition of the square is met by its share.
TEST(Lattice, ShiftedWithinItsCellCoversTheSquareEvenly) {
  constexpr int kBoxes = 16, kSide = 100, kPoints = 32;
  const Lattice lattice = make_lattice(kPoints);
  std::vector<int> met(kBoxes * kBoxes);
  const auto box_of = [](float v) {
    return static_cast<std::size_t>(static_cast<float>(kBoxes) * (v - std::floor(v))) % kBoxes;
  };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const TorusPoint shift = shift_of(lattice, hash_of(x, y));
      for (const TorusPoint& p : lattice.points)
        ++met[box_of(p.u + shift.u) * kBoxes + box_of(p.v + shift.v)];
    }
  }
  const double expected = kSide * kSide * kPoints / static_cast<double>(kBoxes * kBoxes);
  for (const int count : met) EXPECT_NEAR(count / expected, 1, 0.15);
}

TEST(Lattice, HashesOfPixelsThatTouchHaveNothingInCommon) {
  double along = 0, down = 0, first = 0;
  constexpr int kSide = 200;
  const auto unit = [](std::uint32_t bits) { return bits * 0x1p-32 - 0.5; };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const PixelHash here = hash_of(x, y);
      along += 12 * unit(here.first) * unit(hash_of(x + 1, y).first) / (kSide * kSide);
      down += 12 * unit(here.second) * unit(hash_of(x, y + 1).second) / (kSide * kSide);
      first += 12 * unit(here.first) * unit(here.second) / (kSide * kSide);
    }
  }
  for (const double correlation : {along, down, first}) EXPECT_NEAR(correlation, 0, 0.02);
}

}  // namespace
}  // namespace weft::solver
