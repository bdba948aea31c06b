// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/image_io/image_io.h"
#include "tests/core/image_io/scratch_folder.h"
#include "tests/core/image_io/test_images.h"

namespace weft {
namespace {

using namespace std::string_view_literals;
using testing::HasSubstr;
using enum SampleType;
using enum Compression;

struct WholeFile {
  const char* name;
  SampleType type;
  Compression compression;
};

const std::vector<WholeFile> kWholeFiles = {
    {"a.exr", kFloat, kNone}, {"a.exr", kHalf, kZip},   {"a.exr", kHalf, kPiz},   {"a.tif", kUint16, kNone},
    {"a.tif", kUint16, kZip}, {"a.tif", kFloat, kNone}, {"a.png", kUint8, kNone}, {"a.png", kUint16, kNone}};

std::string written(const ScratchFolder& folder, const WholeFile& c) {
  const Image<float> image = exact_noise({97, 89}, 3, kUint16);
  const Result<void> wrote =
      write_image(folder / c.name, views_of(image), {"R", "G", "B"}, {c.type, c.compression});
  EXPECT_TRUE(wrote) << wrote.error().message();
  return bytes_of(folder / c.name);
}

TEST(BrokenImageFile, CutAnywhereIsRefused) {
  const ScratchFolder folder;
  for (const WholeFile& c : kWholeFiles) {
    const std::string bytes = written(folder, c);
    for (const std::size_t kept : {std::size_t{1}, std::size_t{8}, bytes.size() / 100, bytes.size() / 4,
                                   bytes.size() / 2, bytes.size() * 9 / 10, bytes.size() - 1}) {
      put_bytes(folder / c.name, bytes.substr(0, kept));
      const Result<LoadedImage> read = read_image(folder / c.name);
      ASSERT_FALSE(read) << c.name << " " << name_of(c.compression) << ": " << kept << " of " << bytes.size()
                         << " bytes";
      EXPECT_EQ(read.error().kind, ErrorKind::kBadData) << read.error().message();
      EXPECT_EQ(read.error().where, (folder / c.name).string());
    }
  }
}

TEST(BrokenImageFile, WithAnyBytesDamagedIsReadOrRefused) {
  const ScratchFolder folder;
  std::mt19937 random(5);
  int refused = 0;
  for (const WholeFile& c : kWholeFiles) {
    const std::string bytes = written(folder, c);
    for (int round = 0; round < 20; ++round) {
      std::string damaged = bytes;
      const std::size_t where = round % 2 == 0 ? std::min<std::size_t>(400, bytes.size()) : bytes.size();
      for (int k = 0; k < 4; ++k) damaged[random() % where] = static_cast<char>(random());
      put_bytes(folder / c.name, damaged);
      testing::internal::CaptureStderr();
      const Result<LoadedImage> read = read_image(folder / c.name);
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << c.name << ": a library speaks by itself";
      if (!read) ++refused;
    }
  }
  EXPECT_GT(refused, 20) << "of " << 20 * kWholeFiles.size();
}

TEST(BrokenImageFile, ThatIsEmptyTextOrMissingIsRefusedInWords) {
  const ScratchFolder folder;
  put_bytes(folder / "empty.exr", "");
  put_bytes(folder / "text.exr", "This is a letter.\n");
  std::filesystem::create_directories(folder / "folder.exr");
  for (const auto& [name, kind, why] : {std::tuple{"empty.exr", ErrorKind::kBadData, "empty"},
                                        {"text.exr", ErrorKind::kBadData, "no EXR, TIFF"},
                                        {"missing.exr", ErrorKind::kNoInput, "No such file"},
                                        {"folder.exr", ErrorKind::kNoInput, "directory"}}) {
    const Result<LoadedImage> read = read_image(folder / name);
    const Result<ImageFileInfo> info = read_image_info(folder / name);
    ASSERT_FALSE(read) << name;
    ASSERT_FALSE(info) << name;
    EXPECT_EQ(read.error().kind, kind) << name;
    EXPECT_EQ(info.error().kind, kind) << name;
    EXPECT_THAT(read.error().why, HasSubstr(why));
  }
}

TEST(BrokenImageFile, IsKnownByItsContentNotItsName) {
  const ScratchFolder folder;
  put_bytes(folder / "really_png.exr", written(folder, {"a.png", kUint8, kNone}));
  const Result<ImageFileInfo> info = read_image_info(folder / "really_png.exr");
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->format, "png");
}

void put_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = ~0U;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (crc & 1U ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

TEST(BrokenImageFile, ThatClaimsMorePixelsThanMemoryOrFileHoldIsRefusedBeforeAnyIsTaken) {
  const ScratchFolder folder;
  std::string png = written(folder, {"a.png", kUint16, kNone});
  put_big_endian(png, 16, 1'000'000);  // width and height in IHDR
  put_big_endian(png, 20, 1'000'000);
  put_big_endian(png, 29, crc32(std::string_view(png).substr(12, 17)));
  put_bytes(folder / "huge.png", png);
  const Result<LoadedImage> huge = read_image(folder / "huge.png");
  ASSERT_FALSE(huge);

  std::string exr = written(folder, {"a.exr", kFloat, kNone});
  const std::size_t window = exr.find("dataWindow\0box2i\0"sv) + "dataWindow\0box2i\0"sv.size() + 4;
  exr[window + 14] = 0x10;  // y max, little-endian: a million rows more
  put_bytes(folder / "huge.exr", exr);
  const Result<LoadedImage> tall = read_image(folder / "huge.exr");
  ASSERT_FALSE(tall);
  EXPECT_EQ(tall.error().kind, ErrorKind::kBadData) << tall.error().message();
}

}  // namespace
}  // namespace weft
