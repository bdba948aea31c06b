// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace weft::test {
namespace {

using namespace solver;

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

}  // namespace
}  // namespace weft::test
