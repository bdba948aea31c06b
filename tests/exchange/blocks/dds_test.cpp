// SPDX-License-Identifier: Apache-2.0
#include "exchange/blocks/dds.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace weft::exchange {
namespace {

DdsTexture texture_of(BlockFormat format, Size size, int levels, bool is_dx10, bool is_srgb = false) {
  DdsTexture texture{format, is_srgb, is_dx10, size, {}};
  for (int i = 0; i < levels; ++i) {
    std::string level(bytes_of(format, level_size(size, i)), '\0');
    for (std::size_t b = 0; b < level.size(); ++b)
      level[b] = static_cast<char>(31 * b + 7 * texture.levels.size());
    texture.levels.push_back(std::move(level));
  }
  return texture;
}

std::string file_of(const DdsTexture& texture) {
  Result<std::string> file = dds_file(texture);
  EXPECT_TRUE(file) << (file ? "" : file.error().message());
  return file ? *file : std::string();
}

void put(std::string& file, std::size_t offset, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) file[offset + i] = static_cast<char>(value >> (8 * i));
}

TEST(DdsFiles, ComeBackAsTheyWere) {
  for (const BlockFormat format : kBlockFormats) {
    for (const Size size : {Size{1, 1}, Size{4, 4}, Size{7, 5}, Size{64, 16}, Size{1, 9}, Size{100, 36}}) {
      for (const bool is_dx10 : {false, true}) {
        if (!is_dx10 && format == BlockFormat::kBc7) continue;
        for (const int levels : {1, level_count(size)}) {
          const DdsTexture texture = texture_of(format, size, levels, is_dx10);
          const Result<DdsTexture> back = parse_dds(file_of(texture), "weave.dds");
          ASSERT_TRUE(back) << back.error().message();
          EXPECT_EQ(back->format, format);
          EXPECT_EQ(back->is_dx10, is_dx10);
          EXPECT_FALSE(back->is_srgb);
          EXPECT_EQ(back->size, size);
          EXPECT_EQ(back->levels, texture.levels) << name_of(format) << " " << size.width;
        }
      }
    }
  }
}

TEST(DdsFiles, SayThatColourIsSrgb) {
  for (const auto& [format, dxgi] : std::vector<std::pair<BlockFormat, int>>{
           {BlockFormat::kBc1, 72}, {BlockFormat::kBc3, 78}, {BlockFormat::kBc7, 99}}) {
    const std::string file = file_of(texture_of(format, {8, 8}, 1, true, true));
    EXPECT_EQ(file[128], dxgi) << name_of(format);
    const Result<DdsTexture> back = parse_dds(file, "weave.dds");
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_TRUE(back->is_srgb);
  }
}

TEST(DdsFiles, HaveTheHeaderOfTheSpecification) {
  std::string header("DDS ", 4);
  header.resize(148, '\0');
  put(header, 4, 124);         // dwSize
  put(header, 8, 0x000A1007);  // caps, height, width, pixel format, mip map count, linear size
  put(header, 12, 20);         // dwHeight
  put(header, 16, 36);         // dwWidth
  put(header, 20, 9 * 5 * 16);
  put(header, 28, 6);  // dwMipMapCount
  put(header, 76, 32);
  put(header, 80, 4);
  header.replace(84, 4, "DX10");
  put(header, 108, 0x00401008);  // texture, complex, mip map
  put(header, 128, 98);          // DXGI_FORMAT_BC7_UNORM
  put(header, 132, 3);           // D3D10_RESOURCE_DIMENSION_TEXTURE2D
  put(header, 140, 1);
  const std::string file = file_of(texture_of(BlockFormat::kBc7, {36, 20}, 6, true));
  EXPECT_EQ(file.substr(0, 148), header);
  EXPECT_EQ(file.size(), 148U + 16 * (45 + 5 * 3 + 3 * 2 + 1 + 1 + 1));

  const std::string old = file_of(texture_of(BlockFormat::kBc1, {36, 20}, 1, false));
  EXPECT_EQ(old.substr(84, 4), "DXT1");
  EXPECT_EQ(old.size(), 128U + 8 * 45);
}

TEST(DdsFiles, OfWhatTheyCannotHoldAreRefused) {
  const auto refuses = [](const DdsTexture& texture, const char* why) {
    const Result<std::string> file = dds_file(texture);
    ASSERT_FALSE(file) << why;
    EXPECT_EQ(file.error().kind, ErrorKind::kUsage) << why;
  };
  refuses(texture_of(BlockFormat::kBc7, {8, 8}, 1, false), "no FourCC");
  refuses(texture_of(BlockFormat::kBc1, {8, 8}, 1, false, true), "a FourCC says nothing of sRGB");
  refuses(texture_of(BlockFormat::kBc5, {8, 8}, 1, true, true), "data is not sRGB");
  refuses(texture_of(BlockFormat::kBc1, {8, 8}, 0, true), "no levels");
  refuses(texture_of(BlockFormat::kBc1, {8, 8}, 5, true), "8 x 8 has four levels");
  DdsTexture texture = texture_of(BlockFormat::kBc1, {8, 8}, 4, true);
  texture.levels[2] += '\0';
  refuses(texture, "a byte too many");
  texture = texture_of(BlockFormat::kBc1, {8, 8}, 1, true);
  texture.size = {0, 8};
  refuses(texture, "no width");
}

TEST(DdsReader, RefusesEveryFileThatIsCutShortOrGoesOn) {
  for (const bool is_dx10 : {false, true}) {
    const std::string file = file_of(texture_of(BlockFormat::kBc3, {8, 4}, 4, is_dx10));
    for (std::size_t length = 0; length < file.size(); ++length) {
      const auto texture = parse_dds(std::string_view(file).substr(0, length), "weave.dds");
      ASSERT_FALSE(texture) << length << " bytes of " << file.size();
      ASSERT_EQ(texture.error().kind, ErrorKind::kBadData);
      ASSERT_NE(texture.error().where.find("weave.dds"), std::string::npos);
    }
    EXPECT_FALSE(parse_dds(file + '\0', "weave.dds"));
  }
}

TEST(DdsReader, RefusesABrokenTwinOfEachFieldAndNamesIt) {
  const std::string good = file_of(texture_of(BlockFormat::kBc7, {16, 8}, 5, true));
  ASSERT_TRUE(parse_dds(good, ""));
  struct Twin {
    std::size_t offset;
    std::uint32_t value;
    const char* field;
  };
  for (const Twin& twin : std::vector<Twin>{{0, 0x20534443, "magic"},
                                            {4, 128, "size"},
                                            {8, 0x000A1005, "flags"},
                                            {8, 0x00081007, "flags"},
                                            {8, 0x008A1007, "depth"},
                                            {12, 0, "width and height"},
                                            {12, 12, "linear size"},
                                            {16, 0x80000000, "width and height"},
                                            {16, 32, "linear size"},
                                            {20, 257, "linear size"},
                                            {24, 2, "depth"},
                                            {28, 4, "length"},
                                            {28, 6, "mip map count"},
                                            {28, 0xFFFFFFFF, "mip map count"},
                                            {76, 31, "pixel format size"},
                                            {80, 0x44, "pixel format flags"},
                                            {84, 0x36545844, "FourCC"},
                                            {84, 0x31545844, "length"},
                                            {108, 0x00400008, "caps"},
                                            {112, 0xFE00, "caps2"},
                                            {128, 0, "DXGI format"},
                                            {128, 81, "DXGI format"},
                                            {128, 97, "DXGI format"},
                                            {128, 71, "linear size"},
                                            {132, 4, "resource dimension"},
                                            {136, 4, "misc flag"},
                                            {140, 2, "array size"},
                                            {144, 5, "alpha mode"}}) {
    std::string broken = good;
    put(broken, twin.offset, twin.value);
    // A FourCC is believed without the size of a level that BC7 has.
    if (twin.value == 0x31545844) put(broken, 20, 0);
    const auto texture = parse_dds(broken, "weave.dds");
    ASSERT_FALSE(texture) << "offset " << twin.offset << " value " << twin.value;
    EXPECT_EQ(texture.error().where, std::string("weave.dds, ") + twin.field) << texture.error().message();
  }
}

TEST(DdsReader, TakesWhatOtherProgramsLeaveOut) {
  std::string file = file_of(texture_of(BlockFormat::kBc5, {8, 8}, 1, false));
  file.replace(84, 4, "BC5U");
  put(file, 8, 0x1007);
  put(file, 20, 0);
  put(file, 28, 0);
  const Result<DdsTexture> texture = parse_dds(file, "weave.dds");
  ASSERT_TRUE(texture) << texture.error().message();
  EXPECT_EQ(texture->format, BlockFormat::kBc5);
}

}  // namespace
}  // namespace weft::exchange
