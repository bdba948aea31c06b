// SPDX-License-Identifier: Apache-2.0
// What files say of the size of their pixels and of their colours, by their bytes and by the reader.
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/image_io/color_profile.h"
#include "core/image_io/image_io.h"
#include "core/image_io/tiled_texture.h"
#include "tests/core/image_io/scratch_folder.h"
#include "tests/core/image_io/test_images.h"

namespace weft {
namespace {

constexpr double kSizes_mm[] = {0.05, 0.08, 1.0 / 3, 0.0123456789, 25.4, 1000};

Image<float> small_picture() {
  return exact_noise({9, 7}, 3, SampleType::kUint8);
}

void write(const std::filesystem::path& file, const WriteOptions& options) {
  const Image<float> image = small_picture();
  const Result<void> written = write_image(file, views_of(image), {"R", "G", "B"}, options);
  ASSERT_TRUE(written) << written.error().message();
}

// The big-endian numbers of a PNG's pHYs, and its unit.
struct Physical {
  std::uint32_t x = 0, y = 0;
  int unit = -1;
};
Physical physical_of(const std::string& png) {
  const std::size_t at = png.find("pHYs");
  if (at == std::string::npos) return {};
  const auto number = [&](std::size_t from) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(png[from + i]);
    return value;
  };
  return {number(at + 4), number(at + 8), static_cast<unsigned char>(png[at + 12])};
}

TEST(PixelPitch, OfAPngIsInWholePixelsAMetre) {
  const ScratchFolder folder;
  for (const double mm : kSizes_mm) {
    write(folder / "a.png", {.type = SampleType::kUint16, .pitch_mm = {mm, 2 * mm}});
    const Physical physical = physical_of(bytes_of(folder / "a.png"));
    EXPECT_EQ(physical.unit, 1) << "metres";
    EXPECT_EQ(physical.x, std::lround(1000 / mm));
    EXPECT_EQ(physical.y, std::max(1L, std::lround(500 / mm)));
  }
}

TEST(PixelPitch, OfAnExrIsInPixelsAnInch) {
  const ScratchFolder folder;
  for (const double mm : kSizes_mm) {
    write(folder / "a.exr", {.type = SampleType::kHalf, .pitch_mm = {mm, mm}});
    const std::string bytes = bytes_of(folder / "a.exr");
    const std::size_t at = bytes.find("xDensity");
    ASSERT_NE(at, std::string::npos);
    float density = 0;
    std::memcpy(&density, bytes.data() + at + std::strlen("xDensity") + 1 + std::strlen("float") + 1 + 4, 4);
    EXPECT_NEAR(25.4 / static_cast<double>(density) / mm, 1, 1e-6);
  }
}

TEST(PixelPitch, IsReadAsItWasWrittenToSevenDigits) {
  const ScratchFolder folder;
  for (const char* name : {"a.exr", "a.tif"}) {
    for (const double mm : kSizes_mm) {
      if (mm > 25.4 && std::string(name) == "a.tif") continue;
      write(folder / name, {.type = SampleType::kHalf, .pitch_mm = {mm, 0.7 * mm}});
      const auto info = read_image_info(folder / name);
      ASSERT_TRUE(info) << info.error().message();
      EXPECT_NEAR(info->pitch_mm[0] / mm, 1, 1e-6) << name;
      EXPECT_NEAR(info->pitch_mm[1] / (0.7 * mm), 1, 1e-6) << name;
    }
  }
}

TEST(PixelPitch, ThatIsNotKnownIsNotSaid) {
  const ScratchFolder folder;
  for (const char* name : {"a.exr", "a.tif", "a.png"}) {
    const bool is_exr = std::string(name) == "a.exr";
    write(folder / name, {.type = is_exr ? SampleType::kHalf : SampleType::kUint8});
    const auto info = read_image_info(folder / name);
    ASSERT_TRUE(info);
    EXPECT_EQ(info->pitch_mm, PixelPitch()) << name;
    EXPECT_EQ(info->color, ColorSpace::kData) << name;
    EXPECT_EQ(bytes_of(folder / name).find("pHYs"), std::string::npos);
  }
}

TEST(ColorSpaceOfAFile, IsSaidOfColoursAndNeverAsAGamma) {
  const ScratchFolder folder;
  for (const ColorSpace color : {ColorSpace::kData, ColorSpace::kSrgb, ColorSpace::kLinearColor}) {
    write(folder / "a.png", {.type = SampleType::kUint8, .color = color});
    const std::string png = bytes_of(folder / "a.png");
    EXPECT_EQ(png.find("sRGB") != std::string::npos, color == ColorSpace::kSrgb);
    // A gamma of 1 makes browsers brighten linear pictures.
    EXPECT_TRUE(color == ColorSpace::kSrgb || png.find("gAMA") == std::string::npos);
    write(folder / "a.exr", {.type = SampleType::kHalf, .color = color});
    const bool has_primaries = bytes_of(folder / "a.exr").find("chromaticities") != std::string::npos;
    EXPECT_EQ(has_primaries, color == ColorSpace::kLinearColor);
    write(folder / "a.tif", {.type = SampleType::kUint16, .color = color});
    const bool has_profile = bytes_of(folder / "a.tif").find("acsp") != std::string::npos;
    EXPECT_EQ(has_profile, color == ColorSpace::kSrgb);
    const auto png_info = read_image_info(folder / "a.png"), exr_info = read_image_info(folder / "a.exr"),
               tiff_info = read_image_info(folder / "a.tif");
    ASSERT_TRUE(png_info && exr_info && tiff_info);
    EXPECT_EQ(tiff_info->color, color == ColorSpace::kSrgb ? color : ColorSpace::kData);
    EXPECT_EQ(png_info->color, color == ColorSpace::kSrgb ? color : ColorSpace::kData);
    EXPECT_EQ(exr_info->color, color == ColorSpace::kLinearColor ? color : ColorSpace::kData);
  }
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
  return bytes;
}

// CRC-32 of ISO 3309, as PNG has it.
std::uint32_t crc_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

TEST(ColorSpaceOfAFile, FollowsTheGammaOfAPng) {
  const ScratchFolder folder;
  write(folder / "a.png", {.type = SampleType::kUint8});
  const std::string plain = bytes_of(folder / "a.png");
  for (const auto& [gamma, color] :
       {std::pair{100000U, ColorSpace::kLinearColor}, std::pair{45455U, ColorSpace::kSrgb},
        std::pair{55556U, ColorSpace::kOther}}) {
    const std::string chunk = "gAMA" + big_endian(gamma);
    constexpr std::size_t kAfterHeader = 33;
    std::string png = plain;
    png.insert(kAfterHeader, big_endian(4) + chunk + big_endian(crc_of(chunk)));
    std::ofstream(folder / "g.png", std::ios::binary) << png;
    const auto info = read_image_info(folder / "g.png");
    ASSERT_TRUE(info) << info.error().message();
    EXPECT_EQ(info->color, color) << gamma;
  }
}

// By the numbers of ITU-T H.273; those of gAMA stand below.
TEST(ColorSpaceOfAFile, FollowsTheCodePointsOfAPng) {
  const ScratchFolder folder;
  write(folder / "a.png", {.type = SampleType::kUint8});
  const auto chunk_of = [](const std::string& chunk) {
    return big_endian(static_cast<std::uint32_t>(chunk.size() - 4)) + chunk + big_endian(crc_of(chunk));
  };
  for (const auto& [transfer, color] :
       {std::pair{char{8}, ColorSpace::kLinearColor}, std::pair{char{13}, ColorSpace::kSrgb},
        std::pair{char{4}, ColorSpace::kSrgb}, std::pair{char{16}, ColorSpace::kOther},
        std::pair{char{18}, ColorSpace::kOther}, std::pair{char{2}, ColorSpace::kLinearColor}}) {
    constexpr std::size_t kAfterHeader = 33;
    std::string png = bytes_of(folder / "a.png");
    png.insert(kAfterHeader, chunk_of("gAMA" + big_endian(100000)) +
                                 chunk_of(std::string("cICP") + char{1} + transfer + char{0} + char{1}));
    std::ofstream(folder / "c.png", std::ios::binary) << png;
    const auto info = read_image_info(folder / "c.png");
    ASSERT_TRUE(info) << info.error().message();
    EXPECT_EQ(info->color, color) << static_cast<int>(transfer);
  }
}

TEST(ColorProfile, IsToldByItsCurve) {
  const std::vector<std::uint8_t> srgb = srgb_profile();
  EXPECT_EQ(color_of_profile(srgb), ColorSpace::kSrgb);
  // All curves as a power: form 0 of a parametric curve, its number in 65536ths.
  const auto with_gamma = [&](double gamma) {
    std::vector<std::uint8_t> profile = srgb;
    const std::string word = "para", number = big_endian(static_cast<std::uint32_t>(gamma * 65536));
    for (auto at = profile.begin();
         (at = std::search(at, profile.end(), word.begin(), word.end())) != profile.end(); ++at) {
      at[8] = at[9] = 0;
      std::copy(number.begin(), number.end(), at + 12);
    }
    return profile;
  };
  EXPECT_EQ(color_of_profile(with_gamma(1)), ColorSpace::kLinearColor);
  EXPECT_EQ(color_of_profile(with_gamma(2.2)), ColorSpace::kSrgb);
  EXPECT_EQ(color_of_profile(with_gamma(1.8)), ColorSpace::kOther);
  for (std::size_t bytes = 0; bytes < srgb.size(); ++bytes)
    color_of_profile({srgb.data(), bytes});  // is read within its end
  EXPECT_EQ(color_of_profile({srgb.data(), 200}), ColorSpace::kData) << "cut";
}

TEST(TiledTexture, IsTheSameBytesTwiceAndHoldsItsPixels) {
  const ScratchFolder folder;
  const Image<float> image = exact_noise({150, 70}, 3, SampleType::kUint8);
  const TiledTextureOptions options = {
      .is_periodic = true, .pitch_mm = {0.05, 0.05}, .color = ColorSpace::kLinearColor};
  for (const char* name : {"a.tx", "b.tx"}) {
    const Result<void> written =
        write_tiled_texture(folder / name, views_of(image), {"R", "G", "B"}, options);
    ASSERT_TRUE(written) << written.error().message();
  }
  const std::string bytes = bytes_of(folder / "a.tx");
  EXPECT_TRUE(bytes == bytes_of(folder / "b.tx")) << "no date, no command line";
  EXPECT_NE(bytes.find("periodic,periodic"), std::string::npos);
  EXPECT_NE(bytes.find("tiledesc"), std::string::npos);
  const auto read = read_image(folder / "a.tx");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->info.size, (Size{150, 70}));
  EXPECT_EQ(read->info.type, SampleType::kHalf);
  EXPECT_NEAR(read->info.pitch_mm[0], 0.05, 1e-7);
  for (int x = 0; x < 150; ++x) EXPECT_NEAR(read->planes(x, 33, 1), image(x, 33, 1), 0.0005);
}

TEST(TiledTexture, HasInEachLevelTheMeansOfAllPixelsOfTheOneBefore) {
  const ScratchFolder folder;
  Image<float> image({5, 3});
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) image(x, y) = static_cast<float>(10 * x * x + y * y);
  }
  const Result<void> written =
      write_tiled_texture(folder / "a.tx", views_of(image), {"Y"}, {.type = SampleType::kFloat});
  ASSERT_TRUE(written) << written.error().message();
  Imf::TiledInputFile file((folder / "a.tx").c_str());
  ASSERT_EQ(file.numLevels(), 3);
  const auto level = [&](int number) {
    const int width = file.levelWidth(number), height = file.levelHeight(number);
    std::vector<float> samples(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float),
                                  sizeof(float) * static_cast<std::size_t>(width)));
    file.setFrameBuffer(buffer);
    file.readTiles(0, file.numXTiles(number) - 1, 0, file.numYTiles(number) - 1, number);
    return samples;
  };
  // Columns 0 and 1, and 2 to 4; all three rows.
  const float rows = (0 + 1 + 4) / 3.0F, left = 10 * (0 + 1) / 2.0F, right = 10 * (4 + 9 + 16) / 3.0F;
  const std::vector<float> first = level(1), second = level(2);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_FLOAT_EQ(first[0], left + rows);
  EXPECT_FLOAT_EQ(first[1], right + rows);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_FLOAT_EQ(second[0], (left + right) / 2 + rows);
}

TEST(TiledTexture, WithoutPlanesIsRefused) {
  const ScratchFolder folder;
  const Result<void> written = write_tiled_texture(folder / "a.tx", {}, {}, {});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace weft
