// SPDX-License-Identifier: Apache-2.0
// TIFF files of kinds that weft does not write.
#include "tests/core/image_io/foreign_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/image_io/image_io.h"
#include "tests/core/image_io/scratch_folder.h"

namespace weft {
namespace {

struct Pixel {
  int x = 0, y = 0;
  std::vector<double> values;
};

struct Truth {
  std::vector<std::string> channels;
  std::vector<Pixel> pixels;
  SampleType type = SampleType::kUint8;
};

// By the tables of foreign_formats.h: (3, 1) is the last pixel.
const std::map<std::string, Truth> kTruths = {
    {"palette",
     {{"R", "G", "B"},
      {{1, 0, {17 / 255.0, 238 / 255.0, 100 / 255.0}}, {3, 1, {68 / 255.0, 187 / 255.0, 100 / 255.0}}}}},
    {"white_is_0", {{"Y"}, {{1, 0, {0.8}}, {3, 1, {235 / 255.0}}}}},
    {"white_is_0_of_1_bit", {{"Y"}, {{0, 0, {1}}, {1, 0, {0}}, {0, 1, {0}}, {3, 1, {1}}}}},
    {"one_bit", {{"Y"}, {{0, 0, {0}}, {1, 0, {1}}, {0, 1, {1}}, {3, 1, {0}}}}},
    {"ink", {{"R", "G", "B"}, {{1, 0, {0.8 * 0.8, 0.8, 0}}, {3, 1, {0.8 * 235 / 255.0, 0.8, 0}}}}},
    {"separate",
     {{"R", "G", "B"}, {{1, 0, {0.2, 25 / 255.0, 17 / 255.0}}, {3, 1, {20 / 255.0, 10 / 255.0, 6 / 255.0}}}}},
    {"big_endian",
     {{"Y"},
      {{1, 0, {1 / 65535.0}}, {2, 0, {256 / 65535.0}}, {3, 1, {43981 / 65535.0}}},
      SampleType::kUint16}},
    {"big", {{"Y"}, {{1, 0, {0.2}}, {3, 1, {20 / 255.0}}}}},
    {"associated", {{"Y", "A"}, {{1, 0, {0.2, 128 / 255.0}}, {3, 1, {20 / 255.0, 128 / 255.0}}}}}};

TEST(ForeignTiff, OfEveryKindIsReadAsItsNumbersMean) {
  const ScratchFolder folder;
  for (const auto& [name, image] : foreign_tiffs()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(write_foreign(folder / "a.tif", image));
    const Result<LoadedImage> read = read_image(folder / "a.tif");
    ASSERT_TRUE(read) << read.error().message();
    const Truth& truth = kTruths.at(name);
    EXPECT_EQ(read->info.type, truth.type);
    EXPECT_EQ(read->info.size, (Size{4, 2}));
    ASSERT_EQ(read->info.channels, truth.channels);
    for (const Pixel& pixel : truth.pixels) {
      for (std::size_t c = 0; c < pixel.values.size(); ++c)
        EXPECT_NEAR(read->planes(pixel.x, pixel.y, static_cast<int>(c)), pixel.values[c], 1e-6)
            << "channel " << c << " at " << pixel.x << ", " << pixel.y;
    }
  }
}

TEST(ForeignTiff, OfTilesIsReadToItsEdges) {
  const ScratchFolder folder;
  constexpr int kWidth = 37, kHeight = 21;  // of 3 x 2 tiles
  TIFF* tiff = TIFFOpen((folder / "a.tif").c_str(), "w");
  ASSERT_NE(tiff, nullptr);
  for (const auto& [tag, value] : tiff_fields(8, 1, PHOTOMETRIC_MINISBLACK)) TIFFSetField(tiff, tag, value);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWidth);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
  TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
  TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
  for (std::uint32_t t = 0; t < 6; ++t) {
    std::vector<std::uint8_t> tile(256);
    for (std::size_t i = 0; i < tile.size(); ++i)
      tile[i] = static_cast<std::uint8_t>(5 * (16 * (t % 3) + i % 16) + 3 * (16 * (t / 3) + i / 16));
    ASSERT_EQ(TIFFWriteEncodedTile(tiff, t, tile.data(), 256), 256);
  }
  TIFFClose(tiff);
  const Result<LoadedImage> read = read_image(folder / "a.tif");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->info.size, (Size{kWidth, kHeight}));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      ASSERT_NEAR(read->planes(x, y), ((5 * x + 3 * y) & 255) / 255.0, 1e-6) << x << ", " << y;
  }
}

TEST(ForeignTiff, OfInksThatNobodyKnowsIsRefused) {
  const ScratchFolder folder;
  auto fields = tiff_fields(8, 4, PHOTOMETRIC_SEPARATED);
  fields.emplace_back(TIFFTAG_INKSET, INKSET_MULTIINK);
  ASSERT_TRUE(write_foreign(folder / "a.tif", {.fields = fields, .bytes = std::vector<std::uint8_t>(32, 9)}));
  const Result<LoadedImage> read = read_image(folder / "a.tif");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(read.error().message(), testing::HasSubstr("inks"));
}

TEST(ForeignTiff, ThatIsCutCausesNoWordOnStandardError) {
  const ScratchFolder folder;
  for (const auto& [name, image] : foreign_tiffs()) {
    ASSERT_TRUE(write_foreign(folder / "a.tif", image));
    const std::string bytes = bytes_of(folder / "a.tif");
    for (std::size_t kept = 8; kept < bytes.size(); kept += 7) {
      put_bytes(folder / "b.tif", bytes.substr(0, kept));
      testing::internal::CaptureStderr();
      static_cast<void>(read_image(folder / "b.tif"));
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name << ", " << kept << " bytes";
    }
  }
}

}  // namespace
}  // namespace weft
