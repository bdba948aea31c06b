// SPDX-License-Identifier: Apache-2.0
#include "exchange/blocks/encode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "exchange/blocks/decode_blocks.h"
#include "tests/exchange/blocks/block_pictures.h"
#include "tests/simd_targets.h"

namespace weft::exchange {
namespace {

using test::drawn;
using test::largest_difference;
using test::psnr_db;
using test::red_satin;
using test::views_of;

constexpr double kLevel = 1.0 / 255, kExact = 1e-6;

std::string encoded(BlockFormat format, const Image<float>& image, int threads = 1) {
  Result<std::string> blocks = encode_blocks(format, views_of(image), threads);
  EXPECT_TRUE(blocks) << (blocks ? "" : blocks.error().message());
  return blocks ? *blocks : std::string();
}

Image<float> there_and_back(BlockFormat format, const Image<float>& image) {
  Result<Image<float>> decoded = decode_blocks(format, encoded(format, image), image.size());
  EXPECT_TRUE(decoded) << (decoded ? "" : decoded.error().message());
  return decoded ? std::move(*decoded) : Image<float>(image.size(), channels_of(format));
}

// 256 blocks: block v is of value v.
Image<float> all_values(int planes) {
  return drawn({64, 64}, planes, [](int x, int y, int) { return (y / 4 * 16 + x / 4) / 255.0; });
}

TEST(FlatBlocks, OfOneOrTwoChannelsAreExact) {
  for (const BlockFormat format : {BlockFormat::kBc4, BlockFormat::kBc5}) {
    const Image<float> image = all_values(channels_of(format));
    const Image<float> back = there_and_back(format, image);
    for (int p = 0; p < image.planes(); ++p) {
      EXPECT_LT(largest_difference(image, back, p), kExact) << name_of(format) << " plane " << p;
    }
  }
}

TEST(FlatBlocks, OfBlockSevenAreExactUnlessTheyHoldBothZeroAnd255) {
  std::mt19937 random(3);
  for (const int planes : {3, 4}) {
    std::vector<int> colors(static_cast<std::size_t>(1024 * planes));
    for (int& v : colors) v = static_cast<int>(random() % 9 == 0 ? (random() % 2) * 255 : random() % 256);
    const auto color = [&](int x, int y, int p) {
      return colors[static_cast<std::size_t>((y / 4 * 32 + x / 4) * planes + p)];
    };
    const Image<float> image =
        drawn({128, 128}, planes, [&](int x, int y, int p) { return color(x, y, p) / 255.0; });
    const Image<float> back = there_and_back(BlockFormat::kBc7, image);
    for (int y = 0; y < 128; y += 4) {
      for (int x = 0; x < 128; x += 4) {
        bool has_0 = false, has_255 = false;
        for (int p = 0; p < planes; ++p) {
          has_0 |= color(x, y, p) == 0;
          has_255 |= color(x, y, p) == 255;
        }
        for (int p = 0; p < planes; ++p) {
          ASSERT_NEAR(image(x, y, p), back(x, y, p), (has_0 && has_255 ? 1.001 : 0.001) * kLevel)
              << "plane " << p << " of " << planes << " at " << x << ", " << y;
        }
      }
    }
  }
}

// Libsquish takes the interpolation of 8-bit numbers, which is up to a level from the fractions.
TEST(FlatBlocks, OfBlockOneAreWithinTwoLevelsWhereFiveAndSixBitsHoldThem) {
  const Image<float> image = drawn({128, 16}, 3, [](int x, int y, int p) {
    const int v = x / 4;
    return p == 1 ? (2 * v + y / 4 % 2) / 63.0 : (p == 0 ? v : 31 - v) / 31.0;
  });
  const Image<float> back = there_and_back(BlockFormat::kBc1, image);
  for (int p = 0; p < 3; ++p) EXPECT_LT(largest_difference(image, back, p), 2 * kLevel) << "plane " << p;
}

TEST(Ramps, OfAsManyStepsAsAFormatHasAreExact) {
  const Image<float> eight =
      drawn({4, 4}, 1, [](int x, int y, int) { return (20 + 7 * ((4 * y + x) % 8)) * kLevel; });
  EXPECT_LT(largest_difference(eight, there_and_back(BlockFormat::kBc4, eight), 0), kExact);

  constexpr int kSteps[] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
  constexpr int kFirst[] = {10, 200, 30, 254}, kSecond[] = {139, 73, 95, 1};
  for (const int planes : {3, 4}) {
    const Image<float> sixteen = drawn({4, 4}, planes, [&](int x, int y, int p) {
      const int w = kSteps[4 * y + x];
      return (((64 - w) * kFirst[p] + w * kSecond[p] + 32) >> 6) * kLevel;
    });
    const Image<float> back = there_and_back(BlockFormat::kBc7, sixteen);
    for (int p = 0; p < planes; ++p) EXPECT_LT(largest_difference(sixteen, back, p), kExact) << p;
  }
}

TEST(Masks, KeepTheirHolesExactlyBesideARamp) {
  const Image<float> mask = drawn({8, 8}, 1, [](int x, int y, int) {
    return x < 2 ? 0.0 : x > 5 ? 1.0 : (100 + 5 * ((x + y) % 6)) * kLevel;
  });
  const Image<float> back = there_and_back(BlockFormat::kBc4, mask);
  EXPECT_LT(largest_difference(mask, back, 0), kExact);
}

TEST(AlphaEdges, AreExactInBlockThreeAndWithinALevelInBlockSeven) {
  const Image<float> image = drawn({8, 8}, 4, [](int x, int y, int p) {
    constexpr double kColor[] = {115 * kLevel, 20 * kLevel, 31 * kLevel};
    return p < 3 ? kColor[p] : (x + y < 7 ? 0.0 : 1.0);
  });
  const Image<float> three = there_and_back(BlockFormat::kBc3, image);
  EXPECT_LT(largest_difference(image, three, 3), kExact);
  const Image<float> seven = there_and_back(BlockFormat::kBc7, image);
  for (int p = 0; p < 4; ++p) EXPECT_LT(largest_difference(image, seven, p), 1.001 * kLevel) << "plane " << p;
}

TEST(BlockSeven, WithoutAlphaIsOpaque) {
  const Image<float> back = there_and_back(BlockFormat::kBc7, red_satin({64, 64}, 3));
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) ASSERT_GE(back(x, y, 3), 0.9999 * 254 / 255) << x << ", " << y;
  }
}

TEST(BlockSeven, KeepsASatinAboveFiftyFourDecibels) {
  const Image<float> satin = red_satin({256, 256}, 3);
  EXPECT_GT(psnr_db(satin, there_and_back(BlockFormat::kBc7, satin), 3), 54);
}

TEST(BlockOne, KeepsASatinAboveFortyOneDecibels) {
  const Image<float> satin = red_satin({256, 256}, 3);
  EXPECT_GT(psnr_db(satin, there_and_back(BlockFormat::kBc1, satin), 3), 41);
}

double least_error(const std::array<double, 16>& texels, bool is_six, int low, int high) {
  const int last = is_six ? 5 : 7;
  double sum = 0;
  for (const double texel : texels) {
    double least = is_six ? std::min(texel * texel, (texel - 255) * (texel - 255)) : 1e9;
    for (int k = 0; k <= last; ++k) {
      const double off = texel - (low + k * (high - low) / static_cast<double>(last));
      least = std::min(least, off * off);
    }
    sum += least;
  }
  return sum;
}

TEST(BlockFour, IsWithinAPerCentOfTheBestOfAllEndsInTheMean) {
  std::mt19937 random(11);
  double ours = 0, best = 0;
  for (int block = 0; block < 24; ++block) {
    std::array<double, 16> texels = {};
    const double base = block % 3 == 0 ? 0 : 90, spread = 5 + 6 * block;
    for (double& t : texels) t = base + spread * static_cast<double>(random() % 1000) / 1000;
    const Image<float> image = drawn(
        {4, 4}, 1, [&](int x, int y, int) { return texels[static_cast<std::size_t>(4 * y + x)] / 255; });
    const Image<float> back = there_and_back(BlockFormat::kBc4, image);
    for (std::size_t i = 0; i < 16; ++i) {
      const double off = 255.0 * back(static_cast<int>(i % 4), static_cast<int>(i / 4)) - texels[i];
      ours += off * off;
    }
    const auto [least, most] = std::minmax_element(texels.begin(), texels.end());
    const double beyond = 4 + 0.35 * (*most - *least);
    const int from = std::max(0, static_cast<int>(*least - beyond));
    const int to = std::min(255, static_cast<int>(*most + beyond));
    double of_block = 1e9;
    for (int low = from; low <= to; ++low) {
      for (int high = low; high <= to; ++high) {
        of_block = std::min({of_block, high > low ? least_error(texels, false, low, high) : 1e9,
                             least_error(texels, true, low, high)});
      }
    }
    best += of_block;
  }
  EXPECT_GE(ours, 0.9999 * best);
  EXPECT_LT(ours, 1.01 * best) << "square error " << ours << ", best " << best;
}

int planes_for(BlockFormat format) {
  return channels_of(format);
}

TEST(OddSizes, HoldTheSameBlocksAsThePaddedPicture) {
  for (const BlockFormat format : kBlockFormats) {
    for (int height = 1; height <= 5; ++height) {
      for (int width = 1; width <= 7; ++width) {
        const Image<float> image = red_satin({width, height}, planes_for(format));
        const Image<float> padded = padded_to_whole_blocks(views_of(image));
        ASSERT_EQ(padded.size(), whole_blocks(image.size()));
        const std::string blocks = encoded(format, image);
        ASSERT_EQ(blocks.size(),
                  static_cast<std::size_t>((width + 3) / 4 * ((height + 3) / 4)) * block_bytes(format));
        ASSERT_EQ(blocks, encoded(format, padded)) << name_of(format) << " " << width << " x " << height;
        const Image<float> back = there_and_back(format, image);
        ASSERT_EQ(back.size(), image.size());
        for (int p = 0; p < image.planes(); ++p) {
          ASSERT_LT(largest_difference(image, back, p), 0.06) << name_of(format) << " plane " << p;
        }
      }
    }
  }
}

TEST(Blocks, AreTheSameBytesForAnyThreadsAndVectors) {
  for (const BlockFormat format : kBlockFormats) {
    // A multiplication that is fused with its addition changes one block of this picture in bc7.
    const Size size = format == BlockFormat::kBc7 ? Size{1024, 64} : Size{203, 117};
    const Image<float> image = red_satin(size, planes_for(format));
    const std::string one = encoded(format, image, 1);
    for (const int threads : {2, 3, 8}) EXPECT_TRUE(encoded(format, image, threads) == one) << threads;
    test::on_every_target([&] { EXPECT_TRUE(encoded(format, image, 2) == one) << name_of(format); });
  }
}

TEST(Blocks, TakeWhatIsOutOfRangeAsTheNearestAndNoNumberAsZero) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInfinity = std::numeric_limits<float>::infinity();
  const float wild[] = {kNan, -kInfinity, kInfinity, -1e30F, 7, -0.0F};
  const float tame[] = {0, 0, 1, 0, 1, 0};
  for (const BlockFormat format : kBlockFormats) {
    const auto picture = [&](const float* values) {
      return drawn({12, 8}, planes_for(format),
                   [&](int x, int y, int p) { return (x + y) % 2 ? 0.5F : values[(x + 3 * y + p) % 6]; });
    };
    EXPECT_EQ(encoded(format, picture(wild)), encoded(format, picture(tame))) << name_of(format);
  }
}

TEST(Blocks, OfTheWrongPlanesAreRefused) {
  const Image<float> five({8, 8}, 5), small({4, 8}, 3), none({0, 4}, 3);
  auto planes = views_of(five);
  for (const BlockFormat format : kBlockFormats) {
    const Result<std::string> blocks = encode_blocks(format, planes);
    ASSERT_FALSE(blocks) << name_of(format);
    EXPECT_EQ(blocks.error().kind, ErrorKind::kUsage);
  }
  planes.resize(3);
  planes[1] = small.plane(1);
  EXPECT_FALSE(encode_blocks(BlockFormat::kBc7, planes));
  EXPECT_FALSE(encode_blocks(BlockFormat::kBc7, views_of(none)));
  EXPECT_FALSE(encode_blocks(BlockFormat::kBc4, {}));
}

TEST(BlockFormats, AreFoundByTheirNames) {
  for (const BlockFormat format : kBlockFormats) EXPECT_EQ(block_format_named(name_of(format)), format);
  EXPECT_EQ(block_format_named("bc6h"), std::nullopt);
}

}  // namespace
}  // namespace weft::exchange
