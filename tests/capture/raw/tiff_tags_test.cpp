// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/tiff_tags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <vector>

namespace weft::capture {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Bytes of a TIFF in one byte order.
class TiffBytes {
 public:
  explicit TiffBytes(bool big_endian) : big_endian_(big_endian) {
    bytes.assign(2, big_endian ? 'M' : 'I');
    put(42, 2).put(8, 4);
  }

  TiffBytes& put(std::uint64_t number, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      bytes.push_back(static_cast<std::uint8_t>(number >> 8 * (big_endian_ ? size - 1 - i : i)));
    return *this;
  }
  TiffBytes& tag(std::uint16_t id, std::uint16_t type, std::uint32_t count) {
    return put(id, 2).put(type, 2).put(count, 4);
  }

  std::optional<Tiff> read() const {
    return Tiff::read([data = bytes](std::uint64_t offset, std::span<std::uint8_t> out) {
      if (offset > data.size() || out.size() > data.size() - offset) return false;
      std::copy_n(data.begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
      return true;
    });
  }

  std::vector<std::uint8_t> bytes;

 private:
  bool big_endian_;
};

std::vector<double> numbers(const Tiff& tiff, std::uint16_t id) {
  return tiff.numbers(tiff.directories().at(0), id);
}

TEST(TiffTags, AreReadWithEveryTypeOfNumberInBothByteOrders) {
  for (const bool big_endian : {false, true}) {
    TiffBytes file(big_endian);
    constexpr std::uint32_t kValuesAt = 8 + 2 + 11 * 12 + 4;
    file.put(11, 2);
    file.tag(1, 1, 2).put(7, 1).put(255, 1).put(0, 2);  // BYTE
    file.tag(3, 3, 2).put(7, 2).put(65535, 2);          // SHORT
    file.tag(4, 4, 1).put(4294967295u, 4);              // LONG
    file.tag(5, 5, 2).put(kValuesAt, 4);                // RATIONAL
    file.tag(6, 6, 1).put(0xfe, 1).put(0, 3);           // SBYTE
    file.tag(7, 7, 1).put(0xfe, 1).put(0, 3);           // UNDEFINED
    file.tag(8, 8, 1).put(0xfffe, 2).put(0, 2);         // SSHORT
    file.tag(9, 9, 1).put(0xfffffffe, 4);               // SLONG
    file.tag(10, 10, 1).put(kValuesAt + 16, 4);         // SRATIONAL
    file.tag(11, 11, 1).put(std::bit_cast<std::uint32_t>(0.5f), 4);
    file.tag(12, 12, 1).put(kValuesAt + 24, 4);  // DOUBLE
    file.put(0, 4);
    file.put(1, 4).put(60, 4).put(3, 4).put(4, 4);
    file.put(0xfffffffd, 4).put(4, 4);
    file.put(std::bit_cast<std::uint64_t>(-0.1), 8);

    const auto tiff = file.read();
    ASSERT_TRUE(tiff.has_value());
    EXPECT_THAT(numbers(*tiff, 1), ElementsAre(7, 255));
    EXPECT_THAT(numbers(*tiff, 3), ElementsAre(7, 65535));
    EXPECT_THAT(numbers(*tiff, 4), ElementsAre(4294967295.0));
    EXPECT_THAT(numbers(*tiff, 5), ElementsAre(1.0 / 60, 0.75));
    EXPECT_THAT(numbers(*tiff, 6), ElementsAre(-2));
    EXPECT_THAT(numbers(*tiff, 7), ElementsAre(254));
    EXPECT_THAT(numbers(*tiff, 8), ElementsAre(-2));
    EXPECT_THAT(numbers(*tiff, 9), ElementsAre(-2));
    EXPECT_THAT(numbers(*tiff, 10), ElementsAre(-0.75));
    EXPECT_THAT(numbers(*tiff, 11), ElementsAre(0.5));
    EXPECT_THAT(numbers(*tiff, 12), ElementsAre(-0.1));
  }
}

TEST(TiffTags, AreEmptyWhereTheyCannotBeTrusted) {
  TiffBytes file(false);
  constexpr std::uint32_t kValuesAt = 8 + 2 + 9 * 12 + 4;
  file.put(9, 2);
  file.tag(1, 5, 1).put(kValuesAt, 4);  // 1 / 0
  file.tag(2, 11, 1).put(std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()), 4);
  file.tag(3, 3, 0xffffffff).put(8, 4);                // too many
  file.tag(4, 4, 2).put(kValuesAt + 1, 4);             // one byte beyond the end
  file.tag(5, 2, 3).put(0, 4);                         // text
  file.tag(6, 99, 1).put(0, 4);                        // no type
  file.tag(7, 3, 1).put(1, 4).tag(7, 3, 1).put(2, 4);  // twice
  file.tag(8, 3, 2).put(1, 2).put(2, 2);
  file.put(0, 4).put(1, 4).put(0, 4);
  const auto tiff = file.read();
  ASSERT_TRUE(tiff.has_value());
  for (std::uint16_t id = 1; id <= 7; ++id) EXPECT_THAT(numbers(*tiff, id), IsEmpty()) << "tag " << id;
  EXPECT_THAT(numbers(*tiff, 99), IsEmpty());

  const TiffDirectory& directory = tiff->directories()[0];
  EXPECT_EQ(tiff->number(directory, 99, 5), 5) << "absent";
  EXPECT_EQ(tiff->number(directory, 7, 5), std::nullopt) << "twice";
  EXPECT_EQ(tiff->number(directory, 8, 5), std::nullopt) << "two values are not one";
}

TEST(TiffDirectories, AreFollowedOnceEachThroughChainAndChildren) {
  TiffBytes file(false);
  constexpr std::uint32_t kDirectoryBytes = 2 + 12 + 4;
  constexpr std::uint32_t kSecond = 8 + kDirectoryBytes, kChild = kSecond + kDirectoryBytes;
  file.put(1, 2).tag(330, 4, 1).put(kChild, 4).put(kSecond, 4);
  file.put(1, 2).tag(1, 3, 1).put(2, 4).put(8, 4);       // back to the first
  file.put(1, 2).tag(1, 3, 1).put(3, 4).put(kChild, 4);  // back to itself
  const auto tiff = file.read();
  ASSERT_TRUE(tiff.has_value());
  EXPECT_EQ(tiff->directories().size(), 3u);
}

TEST(TiffDirectories, AreNoMoreThan32OfNoMoreThan512Tags) {
  TiffBytes chain(false);
  for (std::uint32_t i = 1; i <= 100; ++i) chain.put(1, 2).tag(1, 3, 1).put(i, 4).put(8 + 18 * i, 4);
  EXPECT_EQ(chain.read()->directories().size(), 32u);

  for (const std::uint16_t tags : {std::uint16_t{512}, std::uint16_t{513}}) {
    TiffBytes wide(false);
    wide.put(tags, 2);
    for (std::uint16_t i = 0; i < tags; ++i) wide.tag(i, 3, 1).put(i, 4);
    wide.put(0, 4);
    EXPECT_EQ(wide.read().has_value(), tags == 512) << tags << " tags";
  }
}

TEST(TiffDirectories, AreNoneWhereThereIsNoTiff) {
  TiffBytes file(false);
  file.put(1, 2).tag(1, 3, 1).put(1, 4).put(0, 4);
  ASSERT_TRUE(file.read().has_value());
  for (const std::size_t length : {0u, 1u, 7u, 8u, 9u, 25u}) {
    TiffBytes cut = file;
    cut.bytes.resize(length);
    EXPECT_FALSE(cut.read().has_value()) << length << " bytes";
  }
  for (const std::size_t at : {0u, 1u, 2u, 3u, 4u}) {
    TiffBytes changed = file;
    changed.bytes[at] = 0x7f;
    EXPECT_FALSE(changed.read().has_value()) << "byte " << at;
  }
}

TEST(TiffDirectories, OfRubbishEnd) {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    TiffBytes file(round % 2 == 1);
    for (int i = 0; i < 300; ++i) file.put(random() % 3 == 0 ? random() % 64 : 0, 1);
    const auto tiff = file.read();
    if (!tiff) continue;
    ASSERT_LE(tiff->directories().size(), 32u);
    for (const TiffDirectory& directory : tiff->directories())
      for (const TiffTag& tag : directory)
        ASSERT_LE(tiff->numbers(directory, tag.id).size(), file.bytes.size()) << "round " << round;
  }
}

}  // namespace
}  // namespace weft::capture
