// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/image_io/image_io.h"
#include "tests/core/image_io/foreign_files.h"
#include "tests/core/image_io/scratch_folder.h"
#include "tests/core/image_io/test_images.h"

namespace weft {
namespace {

using testing::ElementsAre;
using enum SampleType;
using enum Compression;

struct StoredAs {
  const char* ending;
  const char* format;
  SampleType type;
  Compression compression;
};

const std::vector<StoredAs> kStoredAs = {
    {".exr", "openexr", kHalf, kNone},  {".exr", "openexr", kHalf, kZip},  {".exr", "openexr", kHalf, kPiz},
    {".exr", "openexr", kFloat, kNone}, {".exr", "openexr", kFloat, kZip}, {".exr", "openexr", kFloat, kPiz},
    {".tif", "tiff", kUint8, kNone},    {".tif", "tiff", kUint8, kZip},    {".tif", "tiff", kUint16, kNone},
    {".tif", "tiff", kUint16, kZip},    {".tif", "tiff", kHalf, kNone},    {".tif", "tiff", kHalf, kZip},
    {".tif", "tiff", kFloat, kNone},    {".tif", "tiff", kFloat, kZip},    {".png", "png", kUint8, kNone},
    {".png", "png", kUint16, kNone}};

std::string describe(const StoredAs& c) {
  return fmt::format("{} of type {}, {}", c.ending, static_cast<int>(c.type), name_of(c.compression));
}

TEST(ImageRoundTrip, KeepsEveryValueOfEveryFormatTypeAndSize) {
  const ScratchFolder folder;
  for (const StoredAs& c : kStoredAs) {
    for (const Size size : {Size{1, 1}, Size{1, 131}, Size{131, 1}, Size{61, 53}, Size{64, 32}}) {
      for (const int channels : {1, 2, 3, 4}) {
        SCOPED_TRACE(
            fmt::format("{}, {} channels of {} x {}", describe(c), channels, size.width, size.height));
        const std::filesystem::path file = folder / (std::string("image") + c.ending);
        Image<float> written = exact_noise(size, channels, c.type);
        const Result<void> wrote = write_image(file, views_of(written), channel_names(channels),
                                               {.type = c.type, .compression = c.compression});
        ASSERT_TRUE(wrote) << wrote.error().message();
        Result<LoadedImage> read = read_image(file);
        ASSERT_TRUE(read) << read.error().message();
        EXPECT_EQ(read->info.size, size);
        EXPECT_EQ(read->info.type, c.type);
        EXPECT_EQ(read->info.format, c.format);
        EXPECT_EQ(read->info.channels.size(), static_cast<std::size_t>(channels));
        round_to_counts(written, c.type);
        round_to_counts(read->planes, c.type);
        EXPECT_EQ(first_difference(read->planes, written), "");
      }
    }
  }
}

TEST(ImageRoundTrip, KeepsEverySixteenBitCountOfAPng) {
  const ScratchFolder folder;
  Image<std::uint16_t> counts({256, 256});
  for (int i = 0; i < 65536; ++i) counts(i % 256, i / 256) = static_cast<std::uint16_t>(i);
  Result<ImageWriter> writer =
      ImageWriter::open(folder / "status.png", counts.size(), {"Y"}, {.type = kUint16});
  ASSERT_TRUE(writer) << writer.error().message();
  const View<const std::uint16_t> view = counts.plane();
  ASSERT_TRUE(writer->write_rows(view.crop({0, 0, 256, 100})));
  ASSERT_TRUE(writer->write_rows(view.crop({0, 100, 256, 256})));
  ASSERT_TRUE(writer->finish());

  const Result<LoadedImage> read = read_image(folder / "status.png");
  ASSERT_TRUE(read) << read.error().message();
  for (int i = 0; i < 65536; ++i) {
    ASSERT_EQ(std::lround(65535.0f * read->planes(i % 256, i / 256)), i);
  }
}

TEST(ImageRoundTrip, KeepsNanAndInfinityInFloatAndHalf) {
  const ScratchFolder folder;
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  Image<float> written({3, 1});
  written(0, 0) = std::numeric_limits<float>::quiet_NaN();
  written(1, 0) = kInfinite;
  written(2, 0) = -kInfinite;
  for (const SampleType type : {kHalf, kFloat}) {
    for (const char* name : {"a.exr", "a.tif"}) {
      ASSERT_TRUE(write_image(folder / name, views_of(written), {"Y"}, {.type = type}));
      const Result<LoadedImage> read = read_image(folder / name);
      ASSERT_TRUE(read) << read.error().message();
      EXPECT_TRUE(std::isnan(read->planes(0, 0))) << name << " " << read->planes(0, 0);
      EXPECT_EQ(read->planes(1, 0), kInfinite) << name;
      EXPECT_EQ(read->planes(2, 0), -kInfinite) << name;
    }
  }
}

TEST(ImageRoundTrip, FindsExrChannelsByTheirNames) {
  const ScratchFolder folder;
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"X", "Y", "Z"},
        {"R", "G", "B"},
        {"normal_deg", "R", "G", "B"},
        {"normal_deg", "R", "G", "B", "normal_deg.calibration", "R.calibration", "G.calibration",
         "B.calibration"},
        {"R", "G", "R.noise", "R.model", "normal_deg", "normal_deg.model"}}) {
    Image<float> written({2, 2}, static_cast<int>(names.size()));
    for (int p = 0; p < written.planes(); ++p) written(1, 1, p) = static_cast<float>(p + 1);
    ASSERT_TRUE(write_image(folder / "named.exr", views_of(written), names, {}));
    const Result<LoadedImage> read = read_image(folder / "named.exr");
    ASSERT_TRUE(read) << read.error().message();
    for (std::size_t p = 0; p < names.size(); ++p) {
      const View<const float> plane = read->channel(names[p]);
      ASSERT_FALSE(plane.empty()) << names[p];
      EXPECT_EQ(plane(1, 1), static_cast<float>(p + 1)) << names[p];
    }
    EXPECT_TRUE(read->channel("no such channel").empty());
  }
}

TEST(ImageRoundTrip, ReturnsVectorsAndColoursInTheirUsualOrder) {
  const ScratchFolder folder;
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"X", "Y", "Z"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}) {
    const Image<float> image({2, 2}, static_cast<int>(names.size()));
    ASSERT_TRUE(write_image(folder / "a.exr", views_of(image), names, {}));
    EXPECT_EQ(read_image_info(folder / "a.exr")->channels, names);
  }
}

TEST(ImageRoundTrip, KeepsAttributesInEveryFormat) {
  const ScratchFolder folder;
  const ImageAttributes attributes = {{"weft.units", "unit vector"},
                                      {"weft.frame", "rig"},
                                      {"weft.note", "line one\nline two, \"quoted\" \\ {braces}"}};
  const Image<float> image({5, 4});
  for (const StoredAs& c : kStoredAs) {
    const std::filesystem::path file = folder / (std::string("a") + c.ending);
    ASSERT_TRUE(write_image(file, views_of(image), {"Y"}, {c.type, c.compression, attributes}));
    const Result<ImageFileInfo> info = read_image_info(file);
    ASSERT_TRUE(info) << info.error().message();
    EXPECT_EQ(info->attributes, attributes) << describe(c);
  }
}

TEST(ImageRoundTrip, HasNoAttributesWhereNoneWereGiven) {
  const ScratchFolder folder;
  const Image<float> image({5, 4});
  for (const StoredAs& c : kStoredAs) {
    const std::filesystem::path file = folder / (std::string("a") + c.ending);
    ASSERT_TRUE(write_image(file, views_of(image), {"Y"}, {c.type, c.compression}));
    EXPECT_THAT(read_image_info(file)->attributes, testing::IsEmpty()) << describe(c);
  }
}

TEST(ImageRoundTrip, NeitherPremultipliesNorDividesByAlpha) {
  const ScratchFolder folder;
  Image<float> written({1, 1}, 4);
  const float values[] = {200 / 255.0f, 100 / 255.0f, 50 / 255.0f, 51 / 255.0f};
  for (int p = 0; p < 4; ++p) written(0, 0, p) = values[p];
  for (const char* name : {"a.png", "a.tif"}) {
    ASSERT_TRUE(write_image(folder / name, views_of(written), channel_names(4), {.type = kUint8}));
    const Result<LoadedImage> read = read_image(folder / name);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_THAT(read->info.channels, ElementsAre("R", "G", "B", "A"));
    for (int p = 0; p < 4; ++p) EXPECT_NEAR(read->planes(0, 0, p), values[p], 1e-6) << name << " " << p;
  }
}

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

Result<LoadedImage> read_hex(const ScratchFolder& folder, std::string_view hex) {
  put_bytes(folder / "foreign", from_hex(hex));
  return read_image(folder / "foreign");
}

void expect_constant(const LoadedImage& image, const std::string& channel, float value) {
  const View<const float> plane = image.channel(channel);
  ASSERT_FALSE(plane.empty()) << channel;
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      ASSERT_NEAR(plane(x, y), value, 1e-6) << channel << " at " << x << ", " << y;
    }
  }
}

TEST(ForeignFile, OfTilesWithChannelsOfTwoTypesIsRead) {
  const ScratchFolder folder;
  const Result<LoadedImage> read = read_hex(folder, kTiledExr);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->info.size, (Size{9, 5}));
  EXPECT_EQ(read->info.type, kFloat);
  expect_constant(*read, "A.x", 1.0f);
  expect_constant(*read, "R", 0.5f);
  expect_constant(*read, "G", 0.25f);
}

TEST(ForeignFile, WithADataWindowElsewhereGivesItsOwnPixels) {
  const ScratchFolder folder;
  const Result<LoadedImage> read = read_hex(folder, kWindowExr);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->info.size, (Size{9, 5}));
  EXPECT_EQ(read->info.type, kHalf);
  expect_constant(*read, "R", 0.25f);
}

TEST(ForeignFile, OfJpegIsReadWithoutATransferFunction) {
  const ScratchFolder folder;
  const Result<LoadedImage> read = read_hex(folder, kGreyJpeg);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->info.format, "jpeg");
  EXPECT_EQ(read->info.type, kUint8);
  EXPECT_EQ(read->info.size, (Size{8, 8}));
  expect_constant(*read, read->info.channels.at(0), 128 / 255.0f);
}

TEST(ForeignFile, OfPngKeepsColoursUnderTransparency) {
  const ScratchFolder folder;
  const Result<LoadedImage> read = read_hex(folder, kRgbaPng);
  ASSERT_TRUE(read) << read.error().message();
  expect_constant(*read, "R", 1.0f);
  expect_constant(*read, "G", 128 / 255.0f);
  expect_constant(*read, "B", 64 / 255.0f);
  expect_constant(*read, "A", 128 / 255.0f);
}

TEST(ForeignFile, WhoseFirstImageIsAThumbnailIsRefused) {
  const ScratchFolder folder;
  const Result<LoadedImage> read = read_hex(folder, kThumbnailTiff);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(read.error().why, testing::HasSubstr("thumbnail"));
}

TEST(ForeignFile, OfJpegWithABrokenProfileIsReadForWhatItsPixelsAre) {
  const ScratchFolder folder;
  // Two parts of a profile, the first of one and the first of two.
  const std::string profile =
      std::string("FFE200114943435F50524F46494C45000101AA") + "FFE200114943435F50524F46494C45000102AA";
  const std::string sound(kGreyJpeg);
  const Result<LoadedImage> read = read_hex(folder, sound.substr(0, 4) + profile + sound.substr(4));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->info.color, ColorSpace::kSrgb);
}

TEST(ForeignFile, OfJpegThatStopsEarlyIsRefused) {
  const ScratchFolder folder;
  const Result<LoadedImage> read = read_hex(folder, kGreyJpeg.substr(0, kGreyJpeg.size() - 6));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace weft
