// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/dng_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "capture/raw/decode_raw.h"
#include "capture/raw/raw_info.h"
#include "tests/capture/raw/dng_bytes.h"

namespace weft::capture {
namespace {

using testing::HasSubstr;

void expect_refusal(const DngBytes& dng, const std::string& reason) {
  const auto frame = decode_raw(dng.save("layout.dng"));
  ASSERT_FALSE(frame.has_value()) << "decoded, though " << reason;
  EXPECT_EQ(frame.error().kind, ErrorKind::kBadData) << frame.error().message();
  EXPECT_THAT(frame.error().message(), HasSubstr(reason));
}

/// A lossless JPEG (ITU-T T.81, SOF3, predictor 1) of part of a frame, whose code words all have five bits.
std::vector<std::uint8_t> lossless_jpeg(const RawFrame& frame, Rect r) {
  const auto high = [](int n) { return static_cast<std::uint8_t>(n >> 8); };
  const auto low = [](int n) { return static_cast<std::uint8_t>(n & 255); };
  std::vector<std::uint8_t> jpeg = {0xff, 0xd8, 0xff, 0xc4, 0, 36, 0, 0, 0, 0, 0, 17,
                                    0,    0,    0,    0,    0, 0,  0, 0, 0, 0, 0};
  for (std::uint8_t category = 0; category <= 16; ++category) jpeg.push_back(category);
  jpeg.insert(jpeg.end(), {0xff,
                           0xc3,
                           0,
                           11,
                           16,
                           high(r.height()),
                           low(r.height()),
                           high(r.width()),
                           low(r.width()),
                           1,
                           1,
                           0x11,
                           0,
                           0xff,
                           0xda,
                           0,
                           8,
                           1,
                           1,
                           0,
                           1,
                           0,
                           0});
  std::uint64_t bits = 0;
  int held = 0;
  const auto put = [&](unsigned code, int length) {
    bits = bits << length | code;
    for (held += length; held >= 8; held -= 8) {
      jpeg.push_back(static_cast<std::uint8_t>(bits >> (held - 8)));
      if (jpeg.back() == 0xff) jpeg.push_back(0);
    }
  };
  const auto count = [&](int x, int y) {
    return x < frame.counts.width() && y < frame.counts.height() ? frame.counts(x, y) : 0;
  };
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      const int predicted = x > r.x0 ? count(x - 1, y) : y > r.y0 ? count(x, y - 1) : 32768;
      const int difference = count(x, y) - predicted;  // under 32 768 in size for counts of 15 bits
      const auto magnitude = static_cast<unsigned>(std::abs(difference));
      const auto category = static_cast<int>(std::bit_width(magnitude));
      put(static_cast<unsigned>(category), 5);
      if (category > 0) put(difference > 0 ? magnitude : (1u << category) - 1 - magnitude, category);
    }
  put(127, 7);
  jpeg.insert(jpeg.end(), {0xff, 0xd9});
  return jpeg;
}

DngBytes lossless_strip(const RawFrame& frame) {
  DngBytes dng(frame);
  const auto jpeg = lossless_jpeg(frame, {0, 0, frame.counts.width(), frame.counts.height()});
  dng.bytes.resize(dng.get(273));
  dng.bytes.insert(dng.bytes.end(), jpeg.begin(), jpeg.end());
  return dng.set(259, {7}, 2).set(279, {static_cast<std::uint32_t>(jpeg.size())});
}

/// Tiles whose offsets and lengths lie where the colour matrix was.
DngBytes lossless_tiles(const RawFrame& frame, Size tile) {
  DngBytes dng(frame);
  const auto strip_at = dng.get(273);
  const auto arrays_at = static_cast<std::uint32_t>(dng.value_at(50721));
  dng.bytes.resize(strip_at);
  std::vector<std::uint32_t> offsets, lengths;
  for (int y = 0; y < frame.counts.height(); y += tile.height)
    for (int x = 0; x < frame.counts.width(); x += tile.width) {
      const auto jpeg = lossless_jpeg(frame, {x, y, x + tile.width, y + tile.height});
      offsets.push_back(static_cast<std::uint32_t>(dng.bytes.size()));
      lengths.push_back(static_cast<std::uint32_t>(jpeg.size()));
      dng.bytes.insert(dng.bytes.end(), jpeg.begin(), jpeg.end());
      if (dng.bytes.size() % 2 == 1) dng.bytes.push_back(0);
    }
  const auto tiles = static_cast<std::uint32_t>(offsets.size());
  dng.remove(50721).remove(278).set(259, {7}, 2);
  dng.retag(254, 322, 4, 1).set(322, {static_cast<std::uint32_t>(tile.width)});
  dng.retag(50778, 323, 4, 1).set(323, {static_cast<std::uint32_t>(tile.height)});
  dng.retag(273, 324, 4, 1).set(324, {tiles == 1 ? offsets[0] : arrays_at}).retag(324, 324, 4, tiles);
  dng.retag(279, 325, 4, 1)
      .set(325, {tiles == 1 ? lengths[0] : arrays_at + 4 * tiles})
      .retag(325, 325, 4, tiles);
  if (tiles > 1) {
    std::memcpy(dng.bytes.data() + arrays_at, offsets.data(), 4 * tiles);
    std::memcpy(dng.bytes.data() + arrays_at + 4 * tiles, lengths.data(), 4 * tiles);
  }
  return dng;
}

void expect_same_counts(const DngBytes& dng, const RawFrame& truth) {
  const auto frame = decode_raw(dng.save("lossless.dng"));
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  ASSERT_EQ(frame->counts.size(), truth.counts.size());
  for (int y = 0; y < truth.counts.height(); ++y)
    for (int x = 0; x < truth.counts.width(); ++x)
      ASSERT_EQ(frame->counts(x, y), truth.counts(x, y)) << "at " << x << ", " << y;
}

TEST(DngLayout, TakesLosslessJpegInOneStrip) {
  const RawFrame truth = sample_frame({41, 30});
  expect_same_counts(lossless_strip(truth), truth);
}

TEST(DngLayout, TakesLosslessJpegInTiles) {
  const RawFrame truth = sample_frame({41, 30});
  expect_same_counts(lossless_tiles(truth, {16, 16}), truth);
}

TEST(DngLayout, RefusesOneTileWhichLibRawMistakesForAListOfTiles) {
  expect_refusal(lossless_tiles(sample_frame({41, 30}), {48, 32}), "it is one tile");
}

TEST(DngLayout, TakesStripsThatFollowOneAnother) {
  const RawFrame truth = sample_frame({40, 30});
  DngBytes dng(truth);
  const auto strip_at = dng.get(273), arrays_at = static_cast<std::uint32_t>(dng.value_at(50721));
  dng.remove(50721).set(273, {arrays_at}).retag(273, 273, 4, 2).set(278, {15});
  dng.set(279, {arrays_at + 8}).retag(279, 279, 4, 2);
  dng.set(273, {strip_at, strip_at + 1200, 1200, 1200});
  expect_same_counts(dng, truth);
  RawFrame exchanged = sample_frame({40, 30});
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) exchanged.counts(x, y) = truth.counts(x, (y + 15) % 30);
  expect_same_counts(dng.set(273, {strip_at + 1200, strip_at}), exchanged);
  expect_refusal(dng.set(278, {10}), "2 strips or tiles, not 3");
}

TEST(DngLayout, RefusesDataThatAreNotWhatCompressionAndBitsSay) {
  const DngBytes good;
  const auto with = [&good](std::uint16_t tag, std::uint32_t value) {
    return DngBytes(good).set(tag, {value}, 2);
  };
  expect_refusal(with(259, 7), "no lossless JPEG of 40 x 30 counts");
  expect_refusal(with(259, 8), "compression 8 is not read");
  expect_refusal(with(259, 34892), "compression 34892 is not read");
  expect_refusal(with(258, 14), "40 x 30 counts of 14 bits take 2100 bytes, it holds 2400");
  expect_refusal(with(258, 7), "7 bits, not 8 to 16");
  expect_refusal(with(258, 32), "32 bits, not 8 to 16");
}

/// Counts over the whole range of so many bits.
RawFrame frame_of_bits(Size size, int bits) {
  RawFrame frame = sample_frame(size);
  const int most = (1 << bits) - 1;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      frame.counts(x, y) = static_cast<std::uint16_t>((7919 * x + 104729 * y) & most);
  frame.counts(size.width - 1, size.height - 1) = static_cast<std::uint16_t>(most);
  frame.black = {{{16, 16}, {16, 16}}};
  frame.white = static_cast<float>(most);
  return frame;
}

class PackedCounts : public testing::TestWithParam<int> {};

TEST_P(PackedCounts, AreEachReadAtOddAndEvenWidthsInBothByteOrders) {
  for (const Size size :
       {Size{22, 22}, Size{23, 29}, Size{25, 22}, Size{27, 23}, Size{64, 24}, Size{101, 53}}) {
    const RawFrame truth = frame_of_bits(size, GetParam());
    DngBytes dng(truth);
    dng.pack(GetParam());
    expect_same_counts(dng, truth);
    expect_same_counts(dng.make_big_endian(), truth);
  }
}

INSTANTIATE_TEST_SUITE_P(Bits, PackedCounts, testing::Range(8, 16));

TEST(DngLayout, TakesCountsOf16BitsInBothByteOrders) {
  const RawFrame truth = frame_of_bits({23, 29}, 16);
  expect_same_counts(DngBytes(truth), truth);
  expect_same_counts(DngBytes(truth).make_big_endian(), truth);
}

/// The counts of a DNG in uncompressed tiles, which are padded by counts of 77 and lie last to first.
DngBytes plain_tiles(const RawFrame& frame, Size tile, int bits) {
  DngBytes dng(frame);
  dng.bytes.resize(dng.get(273));
  std::vector<std::vector<std::uint8_t>> tiles;
  for (int y0 = 0; y0 < frame.counts.height(); y0 += tile.height)
    for (int x0 = 0; x0 < frame.counts.width(); x0 += tile.width) {
      RawFrame part = sample_frame(tile);
      for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) {
          const bool is_inside = x0 + x < frame.counts.width() && y0 + y < frame.counts.height();
          part.counts(x, y) = is_inside ? frame.counts(x0 + x, y0 + y) : 77;
        }
      DngBytes alone(part);
      if (bits < 16) alone.pack(bits);
      const auto data_at = alone.get(273);
      tiles.emplace_back(alone.bytes.begin() + data_at, alone.bytes.end());
    }
  std::vector<std::uint32_t> offsets(tiles.size());
  for (std::size_t i = tiles.size(); i-- > 0;) {
    offsets[i] = static_cast<std::uint32_t>(dng.bytes.size());
    dng.bytes.insert(dng.bytes.end(), tiles[i].begin(), tiles[i].end());
  }
  const auto count = static_cast<std::uint32_t>(tiles.size());
  const auto lengths_at = static_cast<std::uint32_t>(dng.bytes.size());
  for (const auto& each : tiles) dng.append(static_cast<std::uint32_t>(each.size()), 4);
  for (const std::uint32_t offset : offsets) dng.append(offset, 4);
  dng.set(258, {static_cast<std::uint32_t>(bits)}, 2).remove(278);
  dng.retag(254, 322, 4, 1).set(322, {static_cast<std::uint32_t>(tile.width)});
  dng.retag(50778, 323, 4, 1).set(323, {static_cast<std::uint32_t>(tile.height)});
  dng.retag(273, 324, 4, count).retag(279, 325, 4, count);
  dng.point(324, count == 1 ? offsets[0] : lengths_at + 4 * count);
  return dng.point(325, count == 1 ? static_cast<std::uint32_t>(tiles[0].size()) : lengths_at);
}

TEST(DngLayout, TakesUncompressedTilesThatDoNotDivideTheFrame) {
  for (const int bits : {10, 12, 14, 16})
    for (const Size tile : {Size{16, 16}, Size{17, 9}, Size{48, 32}}) {
      RawFrame truth = sample_frame({41, 30});
      for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 41; ++x)
          truth.counts(x, y) = static_cast<std::uint16_t>(truth.counts(x, y) & ((1 << bits) - 1));
      expect_same_counts(plain_tiles(truth, tile, bits), truth);
    }
  const RawFrame truth = sample_frame({41, 30});
  DngBytes cut = plain_tiles(truth, {16, 16}, 16);
  expect_refusal(cut.set(323, {8}), "6 strips or tiles, not 12");
}

TEST(DngLayout, TakesAnUncompressedTileOfBigEndianCounts) {
  const RawFrame truth = frame_of_bits({23, 29}, 16);
  expect_same_counts(plain_tiles(truth, {32, 32}, 16).make_big_endian(), truth);
}

TEST(DngLayout, TakesPackedCountsInOneStripARow) {
  const RawFrame truth = frame_of_bits({23, 22}, 10);
  DngBytes dng(truth);
  const std::uint32_t strip_at = dng.pack(10).get(273), row_bytes = 29;
  const auto arrays_at = static_cast<std::uint32_t>(dng.bytes.size());
  for (const std::uint32_t step : {row_bytes, 0u})
    for (std::uint32_t y = 0; y < 22; ++y) dng.append(step == 0 ? row_bytes : strip_at + y * step, 4);
  dng.retag(273, 273, 4, 22).point(273, arrays_at).retag(279, 279, 4, 22).point(279, arrays_at + 88);
  expect_same_counts(dng.set(278, {1}), truth);
}

TEST(DngLayout, LooksPackedCountsUpInTheirLinearizationTable) {
  RawFrame truth = frame_of_bits({23, 22}, 8);
  DngBytes dng(truth);
  const auto table_at = static_cast<std::uint32_t>(dng.pack(8).bytes.size());
  for (std::uint32_t i = 0; i < 256; ++i) dng.append(i * i / 4, 2);
  dng.retag(284, 50712, 3, 256).point(50712, table_at).set(50717, {255 * 255 / 4});
  for (int y = 0; y < 22; ++y)
    for (int x = 0; x < 23; ++x) {
      const int count = truth.counts(x, y);
      truth.counts(x, y) = static_cast<std::uint16_t>(count * count / 4);
    }
  expect_same_counts(dng, truth);
}

TEST(DngLayout, RefusesPackedCountsThatAreNotPackedAsItSays) {
  const RawFrame frame = frame_of_bits({23, 22}, 12);
  DngBytes dng(frame);
  dng.pack(12);
  const DngBytes reversed = DngBytes(dng).retag(284, 266, 3, 1).set(266, {2}, 2);
  expect_refusal(reversed, "reverse order");
  // Rows that do not begin a new byte, or all begin a new word.
  for (const std::uint32_t strip_bytes : {23u * 22 * 12 / 8, 36u * 22}) {
    dng.bytes.resize(dng.get(273) + strip_bytes);
    expect_refusal(dng.set(279, {strip_bytes}),
                   "23 x 22 counts of 12 bits take 770 bytes, it holds " + std::to_string(strip_bytes));
  }
}

TEST(DngLayout, RefusesALosslessJpegOfAnotherSizeOrNoLosslessJpeg) {
  const RawFrame frame = sample_frame({41, 30});
  DngBytes dng = lossless_strip(frame);
  const std::size_t sof = dng.get(273) + 2 + 2 + 36;
  ASSERT_EQ(dng.bytes[sof + 1], 0xc3);
  --dng.bytes[sof + 6];
  expect_refusal(dng, "no lossless JPEG of 41 x 30 counts");
  ++dng.bytes[sof + 6];
  dng.bytes[sof + 1] = 0xc0;
  expect_refusal(dng, "no lossless JPEG of 41 x 30 counts");
  dng.bytes[sof + 1] = 0xc3;
  dng.bytes[dng.get(273) + 6] = 3;
  expect_refusal(dng, "no lossless JPEG of 41 x 30 counts");
  dng = lossless_tiles(frame, {16, 16});
  dng.bytes[dng.bytes.size() - 20] = 0xff;  // a marker inside the last tile's data
  dng.bytes[dng.bytes.size() - 19] = 0xd9;
  expect_refusal(dng, "LibRaw");
}

TEST(DngLayout, FindsTheMosaicInASubdirectory) {
  const RawFrame truth = sample_frame({40, 30});
  DngBytes dng(truth);
  const auto raw_directory_at = 8u, preview_directory_at = static_cast<std::uint32_t>(dng.bytes.size());
  // The directory again, as that of a preview whose child is the first one.
  dng.bytes.insert(dng.bytes.end(), dng.bytes.begin() + raw_directory_at, dng.bytes.begin() + dng.get(34665));
  dng.bytes[4] = static_cast<std::uint8_t>(preview_directory_at);
  dng.bytes[5] = static_cast<std::uint8_t>(preview_directory_at >> 8);
  dng.set(254, {1}).set(262, {1}, 2).remove(273).remove(279).remove(33421).remove(33422).remove(258);
  dng.retag(284, 330, 4, 1).set(330, {raw_directory_at});
  expect_same_counts(dng, truth);
}

TEST(DngLayout, RefusesCountsThatAreNotIntegersOfOneMosaic) {
  const DngBytes good;
  expect_refusal(DngBytes(good).retag(284, 339, 3, 1).set(339, {3}, 2), "not unsigned integers");
  expect_refusal(DngBytes(good).set(277, {3}, 2), "3 samples a pixel");
  expect_refusal(DngBytes(good).set(262, {34892}, 2), "0 full-size colour filter arrays");
  expect_refusal(DngBytes(good).set(254, {1}), "0 full-size colour filter arrays");
  expect_refusal(DngBytes(good).retag(284, 50711, 3, 1).set(50711, {2}, 2), "not a Bayer mosaic");
}

RawFrame decoded(const DngBytes& dng) {
  auto frame = decode_raw(dng.save("levels.dng"));
  EXPECT_TRUE(frame.has_value()) << frame.error().message();
  return frame ? std::move(*frame) : RawFrame();
}

TEST(DngLayout, TakesLevelsThatAreNotSaidForWhatTheSpecificationSays) {
  const RawFrame frame = frame_of_bits({23, 22}, 12);
  DngBytes dng(frame);
  dng.pack(12);
  EXPECT_EQ(decoded(DngBytes(dng).remove(50717)).white, 4095);
  EXPECT_EQ(decoded(DngBytes(dng).remove(50714)).black[0][0], 0);
  EXPECT_EQ(decoded(DngBytes(dng).remove(50714).remove(50713)).black[1][1], 0);
  const auto table_at = static_cast<std::uint32_t>(dng.bytes.size());
  for (std::uint32_t i = 0; i < 4096; ++i) dng.append(3 * i + 100, 2);
  dng.retag(284, 50712, 3, 4096).point(50712, table_at);
  EXPECT_EQ(decoded(dng.remove(50717)).white, 3 * 4095 + 100) << "what the largest code stands for";
}

TEST(DngLayout, RefusesImpossibleWhiteLevels) {
  const DngBytes good;
  expect_refusal(DngBytes(good).set(50717, {0}), "white level is 0");
  expect_refusal(DngBytes(good).set(50717, {65536}), "white level is 65536");
  expect_refusal(DngBytes(good).set(50717, {600}), "black level is 600 counts and its white level 600");
}

TEST(DngLayout, RefusesImpossibleBlackLevels) {
  const DngBytes good;
  expect_refusal(DngBytes(good).set(50714, {1, 0}), "black level cannot be read");
  expect_refusal(DngBytes(good).set(50713, {2, 2}, 2), "1 black levels are no pattern");
  expect_refusal(DngBytes(good).retag(50728, 50715, 10, 3), "changes along 3 rows or columns, it has 40");
}

TEST(DngLayout, TakesOffWhatBlackLevelsDifferFromTheCell) {
  // Four by two levels in place of the colour matrix.
  const RawFrame truth = sample_frame({40, 30});
  DngBytes dng(truth);
  dng.remove(50714).retag(50721, 50714, 4, 8).set(50713, {4, 2}, 2);
  dng.set(50714, {600, 601, 602, 603, 600, 601, 602, 603});
  RawFrame frame = decoded(dng);
  using Cell = std::array<std::array<float, 2>, 2>;
  EXPECT_EQ(frame.black, (Cell{{{600, 601}, {602, 603}}}));
  EXPECT_EQ(frame.counts(3, 3), truth.counts(3, 3));
  frame = decoded(dng.set(50714, {600, 601, 602, 603, 700, 601, 602, 603}));
  EXPECT_EQ(frame.black, (Cell{{{650, 601}, {602, 603}}}));
  EXPECT_EQ(frame.counts(2, 4), truth.counts(2, 4) + 50) << "of 600, where the cell says 650";
  EXPECT_EQ(frame.counts(2, 6), truth.counts(2, 6) - 50) << "of 700";
  EXPECT_EQ(frame.counts(3, 6), truth.counts(3, 6));
}

TEST(DngLayout, TakesOffBlackThatChangesAlongRowsAndColumnsAndLeavesFullCountsFull) {
  RawFrame truth = sample_frame({40, 32});
  truth.counts(9, 20) = 15520;
  for (const std::uint16_t tag : {std::uint16_t{50715}, std::uint16_t{50716}}) {
    DngBytes dng(truth);
    const auto length = tag == 50715 ? 40u : 32u;
    const auto deltas_at = static_cast<std::uint32_t>(dng.bytes.size());
    for (std::uint32_t i = 0; i < length; ++i) dng.append(i < length / 2 ? 0 : 80, 4).append(1, 4);
    const RawFrame frame = decoded(dng.retag(50728, tag, 10, length).point(tag, deltas_at));
    EXPECT_EQ(frame.black[1][0], 640) << "600, and half of the rows or columns have 80 more";
    EXPECT_EQ(frame.counts(1, 2), truth.counts(1, 2) + 40);
    EXPECT_EQ(frame.counts(38, 28), truth.counts(38, 28) - 40);
    EXPECT_EQ(frame.counts(9, 20), 15520);
  }
}

TEST(RawInfo, NamesWhatADngAsksADeveloperToDo) {
  const auto with = [](std::uint32_t id, std::uint32_t flags, std::uint32_t gain) {
    DngBytes dng;
    const auto list_at = static_cast<std::uint32_t>(dng.bytes.size());
    const auto big_endian = [&dng](std::uint32_t n) {
      dng.append((n & 255) << 24 | (n & 0xff00) << 8 | (n >> 8 & 0xff00) | n >> 24, 4);
    };
    for (const std::uint32_t n : {1u, id, 0x01030000u, flags, 80u}) big_endian(n);
    for (int i = 0; i < 19; ++i) big_endian(1);
    big_endian(gain);
    dng.retag(284, 51009, 7, 4 + 16 + 80).point(51009, list_at);
    return read_raw_info(dng.save("opcodes.dng"))->opcodes;
  };
  constexpr std::uint32_t kOne = 0x3f800000, kTwo = 0x40000000;
  using Names = std::vector<std::string>;
  EXPECT_EQ(with(9, 0, kTwo), Names{"GainMap"});
  EXPECT_EQ(with(9, 0, kOne), Names{}) << "gains of 1 change nothing";
  EXPECT_EQ(with(1, 1, kOne), Names{"WarpRectilinear (optional)"});
  EXPECT_EQ(with(99, 2, kOne), Names{"opcode 99"});
}

TEST(DngLayout, RefusesSizesThatContradictTheData) {
  const DngBytes good;
  const auto with = [&good](std::uint16_t tag, std::uint32_t value) {
    return DngBytes(good).set(tag, {value});
  };
  expect_refusal(with(256, 38), "38 x 30 counts of 16 bits take 2280 bytes, it holds 2400");
  expect_refusal(with(257, 31), "40 x 31 counts of 16 bits take 2480 bytes, it holds 2400");
  expect_refusal(with(256, 60000), "60000 x 30 counts");
  expect_refusal(with(279, 2398), "it holds 2398");
  expect_refusal(with(256, 0), "its size is 0 x 30 pixels");
  expect_refusal(with(257, 0), "its size is 40 x 0 pixels");
}

TEST(DngLayout, RefusesDataBeyondTheEndOfTheFile) {
  const DngBytes good;
  expect_refusal(DngBytes(good).set(273, {0x7fffffff}), "bytes are missing of");
  expect_refusal(DngBytes(good).set(273, {0}), "a piece of its data is empty");
  expect_refusal(DngBytes(good).set(279, {0xffffffff}), "bytes are missing of");
  expect_refusal(DngBytes(good).remove(279), "does not say where its data are");
}

TEST(DngLayout, RefusesAnActiveAreaOutsideTheSensor) {
  DngBytes dng;
  dng.retag(50728, 50829, 4, 4);
  expect_refusal(dng.set(50829, {0, 0, 31, 40}), "active area does not lie within 40 x 30");
  expect_refusal(dng.set(50829, {4, 0, 4, 40}), "active area does not lie within 40 x 30");
}

}  // namespace
}  // namespace weft::capture
