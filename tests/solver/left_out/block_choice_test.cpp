// SPDX-License-Identifier: Apache-2.0
#include "solver/left_out/block_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace weft::solver {
namespace {

constexpr Size kSize = {1000, 700};

// Writes the same solution everywhere.
class Constant : public Method {
 public:
  Constant(Vec3 normal, float value, std::uint16_t status)
      : normal_(normal), value_(value), status_(status) {}
  void solve(const TileInput& input, const TileOutput& output) const override {
    for (int y = 0; y < input.tile.height(); ++y) {
      for (int x = 0; x < input.tile.width(); ++x) {
        output.normal[0](x, y) = static_cast<float>(normal_.x);
        output.normal[1](x, y) = static_cast<float>(normal_.y);
        output.normal[2](x, y) = static_cast<float>(normal_.z);
        for (std::size_t c = 0; c < 3; ++c) output.albedo[c](x, y) = output.sigma_albedo[c](x, y) = value_;
        output.sigma_normal_deg(x, y) = output.residual(x, y) = value_;
        output.status(x, y) = status_;
      }
    }
  }

 private:
  Vec3 normal_;
  float value_;
  std::uint16_t status_;
};

struct Maps {
  Image<float> planes{kSize, 11};
  Image<std::uint16_t> status{kSize};

  TileOutput output(Rect tile) {
    TileOutput out;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      out.normal[i] = planes.plane(c).crop(tile);
      out.albedo[i] = planes.plane(3 + c).crop(tile);
      out.sigma_albedo[i] = planes.plane(6 + c).crop(tile);
    }
    out.sigma_normal_deg = planes.plane(9).crop(tile);
    out.residual = planes.plane(10).crop(tile);
    out.status = status.plane().crop(tile);
    return out;
  }
};

TileInput tile_input(Rect tile) {
  TileInput input;
  input.tile = tile;
  return input;
}

// The middle block of the top row is better.
BlockChoice one_block() {
  const BlockGrid grid = blocks_of(kSize);
  std::vector<float> weights(grid.count(), 0);
  weights[1] = 1;
  return {grid, std::move(weights)};
}

TEST(BlockChoice, FallsFromOneToZeroBetweenTheCentresOfBlocks) {
  const BlockChoice choice = one_block();
  EXPECT_EQ(choice.weight_at(0, 0), 0) << "left of the first centre";
  EXPECT_EQ(choice.weight_at(127, 0), 0);
  EXPECT_NEAR(choice.weight_at(255, 0), 0.5, 0.5 / 256);
  EXPECT_NEAR(choice.weight_at(256, 0), 0.5, 0.5 / 256);
  EXPECT_NEAR(choice.weight_at(384, 0), 1, 0.5 / 256);
  EXPECT_NEAR(choice.weight_at(384, 256), 0.5, 1.0 / 256);
  EXPECT_EQ(choice.weight_at(384, 640), 0);
  EXPECT_EQ(choice.weight_at(999, 0), 0);
  EXPECT_NEAR(choice.share(), 1.0 / 12, 1e-12);
}

TEST(BlockChoice, SolvesByTheBaseWhereItIsZeroAndBlendsTowardsTheBetter) {
  const Constant base({0, 0, 1}, 0, kShadowed), better({1, 0, 0}, 1, kSpecular);
  const auto blended = blended_method(base, better, one_block());
  const BlockChoice choice = one_block();
  Maps maps;
  const Rect whole = {0, 0, kSize.width, kSize.height};
  blended->solve(tile_input(whole), maps.output(whole));
  for (const auto& [x, y] : {std::pair{50, 50}, {200, 60}, {300, 100}, {384, 128}, {500, 300}, {900, 650}}) {
    const double w = choice.weight_at(x, y);
    const Vec3 expected = normalized({w, 0, 1 - w});
    EXPECT_NEAR(maps.planes(x, y, 0), expected.x, 1e-6) << x << ", " << y;
    EXPECT_NEAR(maps.planes(x, y, 2), expected.z, 1e-6) << x << ", " << y;
    for (int p = 3; p <= 10; ++p) {
      if (p == 4 || p == 5 || p == 7 || p == 8) continue;  // a mosaic has one plane
      EXPECT_NEAR(maps.planes(x, y, p), w, 1e-6) << "plane " << p << " at " << x << ", " << y;
    }
    EXPECT_EQ(maps.status(x, y), w >= 0.5 ? kSpecular : kShadowed) << x << ", " << y;
  }
}

TEST(BlockChoice, DoesNotSeeTiles) {
  const Constant base({0, 0, 1}, 0, 0), better({0.6, 0, 0.8}, 1, 0);
  const auto blended = blended_method(base, better, one_block());
  Maps at_once, by_tiles;
  const Rect whole = {0, 0, kSize.width, kSize.height};
  blended->solve(tile_input(whole), at_once.output(whole));
  for (int y = 0; y < kSize.height; y += 33) {
    for (int x = 0; x < kSize.width; x += 64) {
      const Rect tile = {x, y, std::min(x + 64, kSize.width), std::min(y + 33, kSize.height)};
      blended->solve(tile_input(tile), by_tiles.output(tile));
    }
  }
  int differ = 0;
  for (int p = 0; p < 11; ++p) {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) differ += at_once.planes(x, y, p) != by_tiles.planes(x, y, p);
    }
  }
  EXPECT_EQ(differ, 0);
}

}  // namespace
}  // namespace weft::solver
