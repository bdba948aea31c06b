// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "app/server/view/tile_picture.h"
#include "core/base/temporary_folder.h"
#include "core/image_io/image_io.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr Size kFrame = {1301, 1103};  // odd, one tile at level 2

const Layer kNormals = {"normal", LayerKind::kNormal, "", "normal.exr", {"X", "Y", "Z"}};
const Layer kSigma = {"sigma", LayerKind::kScalar, "deg", "sigma.exr", {"normal_deg"}, true};
const Layer kStatus = {"status", LayerKind::kFlags, "share", "status.png", {"Y"}};

Image<float> slopes() {
  Image<float> normal(kFrame, 3);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      const float p = std::sin(0.7F * static_cast<float>(x)), q = std::cos(1.3F * static_cast<float>(y));
      const float length = std::sqrt(p * p + q * q + 1);
      normal(x, y, 0) = p / length;
      normal(x, y, 1) = q / length;
      normal(x, y, 2) = 1 / length;
    }
  }
  return normal;
}

void write(const fs::path& file, const Image<float>& image, const std::vector<std::string>& channels,
           const WriteOptions& options = {}) {
  std::vector<View<const float>> planes;
  for (int p = 0; p < image.planes(); ++p) planes.push_back(image.plane(p));
  const Result<void> written = write_image(file, planes, channels, options);
  ASSERT_TRUE(written) << written.error().message();
}

Image<float> whole(Pyramid& pyramid, int level, int bit = -1) {
  const Size size = pyramid.size(level);
  Result<Image<float>> image = pyramid.read(level, {0, 0, size.width, size.height}, bit);
  EXPECT_TRUE(image) << image.error().message();
  return std::move(*image);
}

double mean(const Image<float>& image, int plane) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += double{image(x, y, plane)};
  }
  return sum / static_cast<double>(image.size().pixels());
}

TEST(Pyramid, CutsTheMapItself) {
  const TemporaryFolder folder;
  const Image<float> normal = slopes();
  write(folder.path() / "normal.exr", normal, {"X", "Y", "Z"});
  const auto pyramid = Pyramid::open(folder.path(), kNormals, folder.path() / "kept");
  ASSERT_TRUE(pyramid) << pyramid.error().message();
  EXPECT_EQ((*pyramid)->levels(), 5) << "82 x 69 pixels are small on any line";
  EXPECT_EQ((*pyramid)->top(), 2);
  EXPECT_FALSE((*pyramid)->tile(0, 3, 0)) << "1301 pixels are three tiles";
  const Rect last = *(*pyramid)->tile(0, 2, 2);
  EXPECT_EQ(last, (Rect{1024, 1024, 1301, 1103}));
  const Result<Image<float>> tile = (*pyramid)->read(0, last);
  ASSERT_TRUE(tile) << tile.error().message();
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < tile->height(); ++y) {
      for (int x = 0; x < tile->width(); ++x)
        ASSERT_EQ((*tile)(x, y, p), normal(1024 + x, 1024 + y, p)) << x << " " << y;
    }
  }
  EXPECT_FALSE(fs::exists(folder.path() / "kept")) << "nothing had to be kept";
}

TEST(Pyramid, AveragesNormalsAsVectorsSoThatClothIsAsBrightFromAfar) {
  const TemporaryFolder folder;
  const Image<float> normal = slopes();
  write(folder.path() / "normal.exr", normal, {"X", "Y", "Z"});
  const auto pyramid = Pyramid::open(folder.path(), kNormals, folder.path() / "kept");
  ASSERT_TRUE(pyramid) << pyramid.error().message();
  for (int level = 1; level < 3; ++level) {
    const Image<float> far = whole(**pyramid, level);
    EXPECT_EQ(far.size(), (*pyramid)->size(level));
    for (int p = 0; p < 3; ++p) EXPECT_NEAR(mean(far, p), mean(normal, p), 2e-3) << "level " << level;
  }
}

TEST(Pyramid, ReadsACompressedMapAsItReadsAnother) {
  const TemporaryFolder folder;
  write(folder.path() / "normal.exr", slopes(), {"X", "Y", "Z"});
  const auto plain = Pyramid::open(folder.path(), kNormals, folder.path() / "plain");
  ASSERT_TRUE(plain) << plain.error().message();
  fs::create_directory(folder.path() / "zip");
  WriteOptions options;
  options.compression = Compression::kZip;
  write(folder.path() / "zip" / "normal.exr", slopes(), {"X", "Y", "Z"}, options);
  const auto packed = Pyramid::open(folder.path() / "zip", kNormals, folder.path() / "kept");
  ASSERT_TRUE(packed) << packed.error().message();
  for (int level = 0; level < 3; ++level) {
    const Image<float> a = whole(**plain, level), b = whole(**packed, level);
    for (int y = 0; y < a.height(); ++y) {
      ASSERT_EQ(std::memcmp(a.plane(1).row(y), b.plane(1).row(y),
                            sizeof(float) * static_cast<std::size_t>(a.width())),
                0)
          << "level " << level << ", row " << y;
    }
  }
}

TEST(Pyramid, CountsFlagsAsSharesAndDeviationsAsRootsOfSquares) {
  const TemporaryFolder folder;
  Image<std::uint16_t> status(kFrame);
  Image<float> sigma(kFrame);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      status(x, y) = x % 4 == 0 ? 2 : y % 2 == 0 ? 64 : 0;
      sigma(x, y) = x % 2 == 0 ? 3.0F : 1.0F;
    }
  }
  write(folder.path() / "sigma.exr", sigma, {"normal_deg"});
  auto writer = ImageWriter::open(folder.path() / "status.png", kFrame, {"Y"}, {.type = SampleType::kUint16});
  ASSERT_TRUE(writer) << writer.error().message();
  ASSERT_TRUE(writer->write_rows(status.plane()));
  ASSERT_TRUE(writer->finish());

  const auto flags = Pyramid::open(folder.path(), kStatus, folder.path() / "kept");
  ASSERT_TRUE(flags) << flags.error().message();
  EXPECT_EQ(whole(**flags, 0, 1)(4, 1), 1);
  EXPECT_EQ(whole(**flags, 0, 6)(4, 1), 0);
  EXPECT_EQ(whole(**flags, 1, 1)(0, 0), 0.5) << "two of four pixels";
  EXPECT_EQ(whole(**flags, 2, 1)(5, 5), 0.25);
  EXPECT_EQ(whole(**flags, 2)(5, 5), 0.625) << "ten of sixteen have any bit";
  const auto deviation = Pyramid::open(folder.path(), kSigma, folder.path() / "kept");
  ASSERT_TRUE(deviation) << deviation.error().message();
  EXPECT_NEAR(whole(**deviation, 2)(7, 7), std::sqrt(5.0), 2e-3) << "of 9 and 1";
}

TEST(Pyramid, MakesAgainWhatWasEmptied) {
  const TemporaryFolder folder;
  write(folder.path() / "normal.exr", slopes(), {"X", "Y", "Z"});
  const auto pyramid = Pyramid::open(folder.path(), kNormals, folder.path() / "kept");
  ASSERT_TRUE(pyramid) << pyramid.error().message();
  const float before = whole(**pyramid, 2)(100, 100, 0);
  ASSERT_GT(fs::remove_all(folder.path() / "kept"), 0U);
  EXPECT_EQ(whole(**pyramid, 2)(100, 100, 0), before);
}

TEST(Pyramid, SaysWhichMapIsCutShort) {
  const TemporaryFolder folder;
  write(folder.path() / "normal.exr", slopes(), {"X", "Y", "Z"});
  fs::resize_file(folder.path() / "normal.exr", 9'000'000);
  const auto pyramid = Pyramid::open(folder.path(), kNormals, folder.path() / "kept");
  ASSERT_FALSE(pyramid);
  EXPECT_EQ(pyramid.error().kind, ErrorKind::kBadData) << pyramid.error().message();
  EXPECT_NE(pyramid.error().message().find("normal.exr"), std::string::npos);
}

TEST(TilePicture, HoldsFlatClothExactly) {
  Image<float> flat({3, 2}, 3);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) flat(x, y, 2) = 1;
  }
  const std::string raw = raw_tile(LayerKind::kNormal, flat);
  ASSERT_EQ(raw.size(), 24U);
  std::uint32_t packed = 0;
  std::memcpy(&packed, raw.data() + 20, sizeof packed);
  EXPECT_EQ(packed & 1023U, 511U) << "x * 511 + 511";
  EXPECT_EQ(packed >> 10 & 1023U, 511U);
  EXPECT_EQ(packed >> 20 & 1023U, 1022U);
}

TEST(TilePicture, LosesAtMostATenthOfADegree) {
  const Image<float> normal = slopes();
  const std::string raw = raw_tile(LayerKind::kNormal, normal);
  Image<float> back(kFrame, 3);
  const auto* packed = raw.data();
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x, packed += 4) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, packed, sizeof bits);
      for (int p = 0; p < 3; ++p) back(x, y, p) = (static_cast<float>(bits >> (10 * p) & 1023U) - 511) / 511;
    }
  }
  const Image<float> degrees = turned_deg(back, normal);
  float most = 0;
  for (int y = 0; y < kFrame.height; ++y)
    most = std::max(most, *std::max_element(degrees.plane().row(y), degrees.plane().row(y) + kFrame.width));
  EXPECT_LT(most, 0.1) << "degrees";
  EXPECT_GT(most, 0.01) << "degrees: ten bits are not exact";
}

TEST(TilePicture, RefusesNormalsAsJpeg) {
  const Result<std::string> tile =
      picture_tile(LayerKind::kNormal, Image<float>({4, 4}, 3), {}, PictureFormat::kJpeg);
  ASSERT_FALSE(tile);
  EXPECT_EQ(tile.error().kind, ErrorKind::kUsage);
}

TEST(TilePicture, RelitFlatWhiteClothIsTheCosineOfTheLight) {
  Image<float> flat({8, 8}, 3), white({8, 8}, 3);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      flat(x, y, 2) = 1;
      for (int p = 0; p < 3; ++p) white(x, y, p) = 1;
    }
  }
  const TemporaryFolder folder;
  Look look;
  look.light = {0.8, 0, 0.6};
  const Result<std::string> png = relit_tile(flat, white, look, PictureFormat::kPng);
  ASSERT_TRUE(png) << png.error().message();
  std::ofstream(folder.path() / "tile.png", std::ios::binary) << *png;
  const Result<LoadedImage> read = read_image(folder.path() / "tile.png");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_NEAR(255 * read->planes(3, 3, 1), 203, 0.51) << "0.6 in sRGB is 203 of 255";
}

}  // namespace
}  // namespace weft::app
