// SPDX-License-Identifier: Apache-2.0
#include "exchange/blocks/decode_blocks.h"

#include <gtest/gtest.h>
#include <squish.h>

#include <array>
#include <random>
#include <string>

namespace weft::exchange {
namespace {

Image<float> decoded(BlockFormat format, const std::string& blocks, Size size = {4, 4}) {
  Result<Image<float>> image = decode_blocks(format, blocks, size, 1);
  EXPECT_TRUE(image) << (image ? "" : image.error().message());
  return image ? std::move(*image) : Image<float>(size, channels_of(format));
}

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int v : values) text += static_cast<char>(v);
  return text;
}

TEST(DecodedBlockOne, HasThirdsWhereTheFirstEndIsLarger) {
  // 0xf800 red, 0x001f blue; codes 0, 1, 2, 3 in each row.
  const Image<float> image =
      decoded(BlockFormat::kBc1, bytes({0x00, 0xf8, 0x1f, 0x00, 0xe4, 0xe4, 0xe4, 0xe4}));
  const std::array<float, 4> red = {1, 0, 2.0F / 3, 1.0F / 3};
  for (int x = 0; x < 4; ++x) {
    EXPECT_FLOAT_EQ(image(x, 2, 0), red[static_cast<std::size_t>(x)]) << x;
    EXPECT_FLOAT_EQ(image(x, 2, 1), 0) << x;
    EXPECT_FLOAT_EQ(image(x, 2, 2), 1 - red[static_cast<std::size_t>(x)]) << x;
  }
}

TEST(DecodedBlockOne, HasAHalfAndBlackWhereItIsNot) {
  const std::string block = bytes({0x1f, 0x00, 0x00, 0xf8, 0xe4, 0xe4, 0xe4, 0xe4});
  const Image<float> one = decoded(BlockFormat::kBc1, block);
  const std::array<float, 4> red = {0, 1, 0.5F, 0}, blue = {1, 0, 0.5F, 0};
  const Image<float> three = decoded(BlockFormat::kBc3, bytes({9, 9, 0, 0, 0, 0, 0, 0}) + block);
  const std::array<float, 4> red_of_three = {0, 1, 1.0F / 3, 2.0F / 3};
  for (int x = 0; x < 4; ++x) {
    const auto i = static_cast<std::size_t>(x);
    EXPECT_FLOAT_EQ(one(x, 0, 0), red[i]) << x;
    EXPECT_FLOAT_EQ(one(x, 0, 2), blue[i]) << x;
    EXPECT_FLOAT_EQ(three(x, 0, 0), red_of_three[i]) << "block three always has thirds: " << x;
    EXPECT_FLOAT_EQ(three(x, 0, 3), 9.0F / 255) << x;
  }
}

TEST(DecodedBlockFour, HasSeventhsOrFifthsWithZeroAndOne) {
  // Codes 0 to 7, twice.
  const std::string codes = bytes({0x88, 0xc6, 0xfa, 0x88, 0xc6, 0xfa});
  const Image<float> eight = decoded(BlockFormat::kBc4, bytes({240, 30}) + codes);
  const Image<float> six = decoded(BlockFormat::kBc4, bytes({30, 230}) + codes);
  const std::array<float, 8> of_eight = {240, 30, 210, 180, 150, 120, 90, 60};
  const std::array<float, 8> of_six = {30, 230, 70, 110, 150, 190, 0, 255};
  for (int i = 0; i < 16; ++i) {
    const auto code = static_cast<std::size_t>(i % 8);
    EXPECT_FLOAT_EQ(eight(i % 4, i / 4), of_eight[code] / 255) << i;
    EXPECT_FLOAT_EQ(six(i % 4, i / 4), of_six[code] / 255) << i;
  }
}

TEST(DecodedBlockSeven, InterpolatesSixtyFourthsOfEightBitEnds) {
  // Mode 6, ends 0 and 127 in all channels, low bits 0 and 1: 0 to 255; indices 0 to 15.
  const Image<float> image =
      decoded(BlockFormat::kBc7, bytes({0x40, 0xc0, 0x1f, 0xf0, 0x07, 0xfc, 0x01, 0x7f, 0x11, 0x32, 0x54,
                                        0x76, 0x98, 0xba, 0xdc, 0xfe}));
  constexpr std::array<int, 16> kValues = {0,   16,  36,  52,  68,  84,  104, 120,
                                           135, 151, 171, 187, 203, 219, 239, 255};
  for (int i = 0; i < 16; ++i) {
    for (int p = 0; p < 4; ++p) {
      EXPECT_FLOAT_EQ(image(i % 4, i / 4, p), static_cast<float>(kValues[static_cast<std::size_t>(i)]) / 255)
          << "index " << i << " plane " << p;
    }
  }
}

std::string random_block(std::mt19937& random, std::size_t length) {
  std::string block(length, '\0');
  for (char& b : block) b = static_cast<char>(random());
  return block;
}

// What it makes of a block of `kind`, within its rounding.
void expect_as_libsquish(const Image<float>& ours, int plane, const std::string& block, int kind,
                         int channel) {
  std::array<squish::u8, 64> theirs = {};
  squish::Decompress(theirs.data(), block.data(), kind);
  for (int i = 0; i < 16; ++i) {
    ASSERT_NEAR(255 * ours(i % 4, i / 4, plane), theirs[static_cast<std::size_t>(4 * i + channel)], 1.51)
        << "texel " << i << " plane " << plane;
  }
}

TEST(DecodedBlocks, AreThoseOfLibsquishWithinItsRounding) {
  std::mt19937 random(5);
  for (int n = 0; n < 500; ++n) {
    const std::string eight = random_block(random, 8), sixteen = random_block(random, 16);
    const Image<float> one = decoded(BlockFormat::kBc1, eight), three = decoded(BlockFormat::kBc3, sixteen);
    for (int p = 0; p < 3; ++p) expect_as_libsquish(one, p, eight, squish::kDxt1, p);
    for (int p = 0; p < 4; ++p) expect_as_libsquish(three, p, sixteen, squish::kDxt5, p);
    // A channel is stored as the alpha of block three is.
    const Image<float> four = decoded(BlockFormat::kBc4, eight), five = decoded(BlockFormat::kBc5, sixteen);
    expect_as_libsquish(four, 0, eight + eight, squish::kDxt5, 3);
    expect_as_libsquish(five, 0, sixteen, squish::kDxt5, 3);
    expect_as_libsquish(five, 1, sixteen.substr(8) + eight, squish::kDxt5, 3);
  }
}

TEST(DecodedBlocks, OfTheWrongLengthOrModeAreRefused) {
  for (const BlockFormat format : kBlockFormats) {
    for (const std::size_t length : {std::size_t{0}, block_bytes(format) - 1, block_bytes(format) + 1}) {
      const auto image = decode_blocks(format, std::string(length, '\0'), {4, 4});
      ASSERT_FALSE(image) << name_of(format) << " " << length;
      EXPECT_EQ(image.error().kind, ErrorKind::kBadData);
    }
    EXPECT_FALSE(decode_blocks(format, "", {0, 0}));
  }
  for (const int first : {0x00, 0x01, 0x20, 0x80}) {
    EXPECT_FALSE(decode_blocks(BlockFormat::kBc7, bytes({first}) + std::string(15, '\0'), {4, 4})) << first;
  }
}

}  // namespace
}  // namespace weft::exchange
