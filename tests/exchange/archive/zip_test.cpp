// SPDX-License-Identifier: Apache-2.0
#include "exchange/archive/zip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/exchange/export_checks.h"

namespace weft::exchange {
namespace {

using testing::HasSubstr;

std::string archive_of(const std::vector<ZipEntry>& entries, ZipKind kind) {
  const auto zip = zip_of(entries, kind);
  EXPECT_TRUE(zip) << (zip ? "" : zip.error().message());
  return zip ? *zip : std::string();
}

std::string refusal_of(const Result<void>& result) {
  return result ? "" : result.error().message();
}
std::string refusal_of(const std::vector<ZipEntry>& entries) {
  const auto zip = zip_of(entries, ZipKind::kStrict);
  return zip ? "" : zip.error().message();
}

std::string bytes_of_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size();) {
    if (hex[i] == ' ') {
      ++i;
      continue;
    }
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    i += 2;
  }
  return bytes;
}

// By hand, from APPNOTE 6.3.10; the checksum of "123456789" is the check value of CRC-32.
TEST(StrictZip, IsTheBytesOfTheSpecification) {
  const std::string common = "1400 0008 0000 0000 2100 2639f4cb 09000000 09000000 0100";
  const std::string expected =
      bytes_of_hex("504b0304" + common + "0000") + "a123456789" +
      bytes_of_hex("504b0102 3f00" + common + "0000 0000 0000 0000 00000000 00000000") + "a" +
      bytes_of_hex("504b0506 0000 0000 0100 0100 2f000000 28000000 0000");
  const std::string zip = archive_of({{"a", "123456789"}}, ZipKind::kStrict);
  EXPECT_EQ(testing::PrintToString(zip), testing::PrintToString(expected));
}

TEST(AlignedZip, BeginsEveryPayloadAtAMultipleOf64) {
  for (std::size_t length = 1; length <= 80; ++length) {
    const std::string name(length, 'n');
    const std::string first(length * 7 % 97, 'x'), second = "the second file";
    const std::string zip = archive_of({{name, first}, {"second.png", second}}, ZipKind::kAligned);
    EXPECT_EQ(zip.find(second) % 64, 0u) << "with a name of " << length << " bytes";
    EXPECT_EQ(refusal_of(check_zip(zip, ZipKind::kAligned)), "");
  }
}

TEST(AlignedZip, IsRefusedWhereAPayloadIsElsewhere) {
  const std::string zip = archive_of({{"cloth.usda", "#usda 1.0"}}, ZipKind::kStrict);
  EXPECT_THAT(refusal_of(check_zip(zip, ZipKind::kAligned)), HasSubstr("begin at 40"));
}

TEST(StrictZip, IsRefusedWithExtraFields) {
  const std::string zip = archive_of({{"cloth.u3m", "{}"}}, ZipKind::kAligned);
  EXPECT_THAT(refusal_of(check_zip(zip, ZipKind::kStrict)), HasSubstr("extra field"));
}

TEST(CheckZip, RefusesEveryChangeOfAByte) {
  for (const ZipKind kind : {ZipKind::kStrict, ZipKind::kAligned}) {
    const std::string zip = archive_of({{"a.u3m", "{}"}, {"t/b.png", "texels"}, {"c", ""}}, kind);
    ASSERT_EQ(refusal_of(check_zip(zip, kind)), "");
    for (std::size_t i = 0; i < zip.size(); ++i) {
      for (const int bit : {1, 8, 128}) {
        std::string broken = zip;
        broken[i] = static_cast<char>(broken[i] ^ bit);
        EXPECT_NE(refusal_of(check_zip(broken, kind)), "") << "byte " << i << " of " << zip.size();
      }
    }
  }
}

TEST(CheckZip, RefusesWhatIsCutOffOrContinued) {
  const std::string zip = archive_of({{"a.u3m", "{}"}, {"t/b.png", "texels"}}, ZipKind::kStrict);
  for (std::size_t size = 0; size < zip.size(); ++size) {
    EXPECT_NE(refusal_of(check_zip(zip.substr(0, size), ZipKind::kStrict)), "") << size << " bytes";
  }
  EXPECT_NE(refusal_of(check_zip(zip + "x", ZipKind::kStrict)), "");
  EXPECT_NE(refusal_of(check_zip("x" + zip, ZipKind::kStrict)), "");
}

TEST(Zip, RefusesNamesThatCollideOrArePortableNowhere) {
  EXPECT_THAT(refusal_of({{"A.png", ""}, {"a.PNG", ""}}), HasSubstr("case of letters"));
  for (const char* name :
       {"", "/a", "a/", "a//b", "../a", "a/./b", "a\\b", "con.png", "a/LPT1", "a.", "a?b"}) {
    EXPECT_NE(refusal_of({{name, ""}}), "") << name;
  }
  EXPECT_THAT(refusal_of(std::vector<ZipEntry>()), HasSubstr("none"));
}

TEST(Zip, RefusesFourGibibytes) {
  static const char kByte = 0;
  const std::string_view never_read(&kByte, std::size_t{1} << 32);
  EXPECT_THAT(refusal_of({{"big.png", never_read}}), HasSubstr("4 GiB"));
}

TEST(Zip, HasTheSameBytesTwice) {
  const std::vector<ZipEntry> entries = {{"a.usda", "#usda"}, {"t/b.png", "texels"}};
  EXPECT_EQ(archive_of(entries, ZipKind::kAligned), archive_of(entries, ZipKind::kAligned));
}

}  // namespace
}  // namespace weft::exchange
