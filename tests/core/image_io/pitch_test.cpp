// SPDX-License-Identifier: Apache-2.0
// What files say of the size of their pixels and of their colours, by their bytes and by the reader.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

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
    // OpenImageIO's gamma of 1 makes browsers brighten linear pictures.
    EXPECT_TRUE(color == ColorSpace::kSrgb || png.find("gAMA") == std::string::npos);
    write(folder / "a.exr", {.type = SampleType::kHalf, .color = color});
    const bool has_primaries = bytes_of(folder / "a.exr").find("chromaticities") != std::string::npos;
    EXPECT_EQ(has_primaries, color == ColorSpace::kLinearColor);
    const auto png_info = read_image_info(folder / "a.png"), exr_info = read_image_info(folder / "a.exr");
    ASSERT_TRUE(png_info && exr_info);
    EXPECT_EQ(png_info->color, color == ColorSpace::kSrgb ? color : ColorSpace::kData);
    EXPECT_EQ(exr_info->color, color == ColorSpace::kLinearColor ? color : ColorSpace::kData);
  }
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

TEST(TiledTexture, WithoutPlanesIsRefused) {
  const ScratchFolder folder;
  const Result<void> written = write_tiled_texture(folder / "a.tx", {}, {}, {});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace weft
