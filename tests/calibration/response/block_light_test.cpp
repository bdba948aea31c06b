// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/block_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/oracles/virtual_sensor.h"

namespace weft::calibration {
namespace {

RawFrame flat_frame(std::uint16_t count) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({64, 40});
  for (auto& row : frame.black) row.fill(100);
  frame.white = 1100;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 64; ++x) frame.counts(x, y) = count;
  }
  return frame;
}

TEST(BlockLight, HoldsMomentsOfWholeSquaresOnly) {
  const BlockLight light = block_light(flat_frame(600), {});
  ASSERT_EQ(light.grid, (Size{2, 1}));
  for (const auto& block : light.blocks) {
    EXPECT_EQ(block[0].photosites, 256);
    EXPECT_EQ(block[1].photosites, 512);
    for (const Moments& m : block) {
      EXPECT_DOUBLE_EQ(m.v, 0.5);
      EXPECT_DOUBLE_EQ(m.v2, 0.25);
      EXPECT_DOUBLE_EQ(m.v3, 0.125);
    }
  }
  EXPECT_DOUBLE_EQ(light.mean[2], 0.5);
}

TEST(BlockLight, LeavesOutSquaresWithAFullOrABlackPhotositeOfTheChannel) {
  RawFrame frame = flat_frame(600);
  frame.counts(0, 0) = 1090;  // red, from 98 percent on
  frame.counts(33, 1) = 0;    // blue
  const BlockLight light = block_light(frame, {});
  EXPECT_EQ(light.blocks[0][0].photosites, 0);
  EXPECT_EQ(light.blocks[0][2].photosites, 256);
  EXPECT_EQ(light.blocks[1][2].photosites, 0);
  EXPECT_DOUBLE_EQ(light.full_share[0], 1.0 / 512);
  EXPECT_DOUBLE_EQ(light.zero_share, 1.0 / 2048);
}

TEST(BlockLight, DoesNotLookAtBadPhotosites) {
  RawFrame frame = flat_frame(600);
  frame.counts(0, 0) = 1090;
  Image<std::uint8_t> bad({64, 40});
  bad(0, 0) = 1;
  const BlockLight light = block_light(frame, bad.plane());
  EXPECT_EQ(light.blocks[0][0].photosites, 255);
  EXPECT_DOUBLE_EQ(light.blocks[0][0].v, 0.5);
}

TEST(BlockLight, JoinsFramesToTheirMean) {
  BlockLight sum;
  join(sum, block_light(flat_frame(400), {}));
  join(sum, block_light(flat_frame(600), {}));
  join(sum, block_light(flat_frame(800), {}));
  EXPECT_EQ(sum.frames, 3);
  EXPECT_NEAR(sum.blocks[1][1].v, 0.5, 1e-14);
  EXPECT_NEAR(sum.blocks[1][1].v2, (0.09 + 0.25 + 0.49) / 3, 1e-14);
  EXPECT_EQ(sum.blocks[1][1].photosites, 3 * 512);
}

TEST(BlockLight, ShiftsMomentsAsPowersDo) {
  const Moments m = shifted({0.5, 0.25, 0.125, 1}, 0.2);
  EXPECT_NEAR(m.v, 0.3, 1e-15);
  EXPECT_NEAR(m.v2, 0.09, 1e-15);
  EXPECT_NEAR(m.v3, 0.027, 1e-15);
}

TEST(BlockLight, HasNoSquareInAFrameSmallerThanOne) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({31, 31});
  frame.white = 100;
  EXPECT_TRUE(block_light(frame, {}).blocks.empty());
}

}  // namespace
}  // namespace weft::calibration
