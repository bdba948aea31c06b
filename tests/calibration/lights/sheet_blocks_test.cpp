// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/sheet_blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "bench/oracles/oracle_rig.h"

namespace weft::calibration {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kFull = std::numeric_limits<float>::infinity();
constexpr int kSide = 16;

// One row of blocks of a mosaic.
SheetBlockGrid averaged(Size size, const std::function<float(int x, int y)>& reading) {
  Image<float> frame(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) frame(x, y) = reading(x, y);
  }
  SheetBlockGrid grid(size, kSide);
  for (int row = 0; row < grid.rows; ++row)
    average_row(grid, row, frame.plane().crop({0, row * kSide, size.width, (row + 1) * kSide}), CfaPattern());
  return grid;
}

TEST(SheetBlocks, ReadASlopeAtTheirCentreInEveryChannel) {
  // Red and blue photosites are half a pixel to either side of the centre: the slope must not shift them.
  const SheetBlockGrid grid =
      averaged({48, 32}, [](int x, int y) { return static_cast<float>(100 + 2 * x - 3 * y); });
  ASSERT_EQ(grid.columns, 3);
  ASSERT_EQ(grid.rows, 2);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(grid.at(1, 1, c).reading, 100 + 2 * 23.5 - 3 * 23.5, 1e-9) << "channel " << c;
    EXPECT_NEAR(grid.at(1, 1, c).standard_error, 0, 1e-5) << "a slope is no noise";
  }
  EXPECT_EQ(grid.at(0, 0, 0).count, 64);
  EXPECT_EQ(grid.at(0, 0, 1).count, 128);
}

TEST(SheetBlocks, LeaveOutWhatIsFarOut) {
  const auto reading = [](int x, int y) {
    if (x == 4 && y == 6) return 9000.0f;  // a hot photosite, of red
    return 100 + (((x / 2 + y / 2) % 2 == 0) ? 1.0f : -1.0f);
  };
  const SheetBlockGrid grid = averaged({16, 16}, reading);
  EXPECT_EQ(grid.at(0, 0, 0).clipped, 1);
  EXPECT_EQ(grid.at(0, 0, 0).count, 63);
  EXPECT_NEAR(grid.at(0, 0, 0).reading, 100, 0.1);
  EXPECT_EQ(grid.at(0, 0, 1).clipped, 0);
}

TEST(SheetBlocks, KnowTheirStandardError) {
  test::Random random(3);
  const SheetBlockGrid grid =
      averaged({1600, 64}, [&](int, int) { return static_cast<float>(100 + 2 * random.normal()); });
  double off = 0, claimed = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const BlockMean& block = grid.at(column, row, 1);
      off += (block.reading - 100) * (block.reading - 100);
      claimed += static_cast<double>(block.standard_error) * static_cast<double>(block.standard_error);
    }
  }
  // 400 blocks: the ratio of the two sums is known to 7 percent.
  EXPECT_NEAR(off / claimed, 1, 0.2) << "errors are " << std::sqrt(off / claimed) << " of what is claimed";
}

TEST(SheetBlocks, SaySoWherePhotositesAreFullOrMissing) {
  const SheetBlockGrid grid = averaged({48, 16}, [](int x, int y) {
    if (x == 2 && y == 2) return kFull;
    if (x >= 16 && x < 32 && y < 12) return kNaN;
    return 5.0f;
  });
  EXPECT_TRUE(std::isnan(grid.at(0, 0, 0).reading));
  EXPECT_EQ(grid.at(0, 0, 0).full, 1);
  EXPECT_EQ(grid.at(0, 0, 1).reading, 5) << "green is not full";
  EXPECT_TRUE(std::isnan(grid.at(1, 0, 1).reading)) << "three quarters are missing";
  EXPECT_EQ(grid.at(2, 0, 1).reading, 5);
}

TEST(SheetBlocks, OfDevelopedPicturesAreThoseOfTheirPlanes) {
  Image<float> rgb({16, 16}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) rgb(x, y, c) = static_cast<float>(10 * c + x);
    }
  }
  SheetBlockGrid grid({16, 16}, kSide);
  average_row(grid, 0, std::array<View<const float>, 3>{rgb.plane(0), rgb.plane(1), rgb.plane(2)});
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(grid.at(0, 0, c).reading, 10 * c + 7.5, 1e-9);
    EXPECT_EQ(grid.at(0, 0, c).count, 256);
  }
}

TEST(SheetBlocks, OfAHundredMegapixelsAddUpExactly) {
  // Readings of a million and a fraction, which sums in float would lose: 16384 x 6400, in which one band of
  // rows comes again and again, for the test's own speed.
  const Size frame = {16384, 6400};
  Image<float> band({frame.width, kSide});
  test::Random random(5);
  long double exact = 0;
  for (int x = 0; x < frame.width; ++x) {
    const auto base = static_cast<float>(1e6 + random.uniform());
    for (int y = 0; y < kSide; ++y) {
      band(x, y) = base + static_cast<float>((x * 7 + y * 3) % 11);
      exact += static_cast<long double>(band(x, y)) / (static_cast<long double>(frame.width) * kSide);
    }
  }
  SheetBlockGrid grid(frame, kSide);
  average_row(grid, 0, std::array<View<const float>, 3>{band.plane(), band.plane(), band.plane()});
  std::vector<std::array<int, 2>> places;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      for (int c = 0; c < 3; ++c) grid.at(column, row, c) = grid.at(column, 0, c);
      places.push_back({column, row});
    }
  }
  const auto found = static_cast<long double>(merge(grid, places).reading_rgb[1]);
  EXPECT_LT(std::abs(static_cast<double>((found - exact) / exact)), 1e-13)
      << "mean " << static_cast<double>(found) << " of " << static_cast<double>(exact);
}

TEST(SheetBlocks, MergeToTheMeanOfThoseThatAreWhole) {
  const SheetBlockGrid grid =
      averaged({64, 16}, [](int x, int y) { return x == 3 && y == 3 ? kFull : static_cast<float>(x / 16); });
  const std::vector<std::array<int, 2>> places = {{0, 0}, {1, 0}, {3, 0}};
  const MergedBlock merged = merge(grid, places);
  EXPECT_EQ(merged.blocks, 2) << "the first has a full photosite";
  EXPECT_NEAR(merged.reading_rgb[1], 2, 1e-12);
  EXPECT_NEAR(merged.x_px, (23.5 + 55.5) / 2, 1e-12);
  EXPECT_EQ(merge(grid, {}).blocks, 0);
}

TEST(SheetBlocks, CountTextureThatIsCoarserThanAPhotosite) {
  // Every block is even, but they differ by 1 in 10: their mean is not known to the zero that each claims.
  const SheetBlockGrid grid = averaged({256, 16}, [](int x, int) { return x / 16 % 2 == 0 ? 9.0f : 11.0f; });
  std::vector<std::array<int, 2>> places;
  for (int column = 0; column < 16; ++column) places.push_back({column, 0});
  EXPECT_NEAR(merge(grid, places).relative_sigma[1], 0.1 / 4, 0.004);
}

}  // namespace
}  // namespace weft::calibration
