// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/swatch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/temporary_folder.h"
#include "core/image_io/image_io.h"
#include "report/preview.h"

namespace weft::app {
namespace {

constexpr Size kMaps = {600, 400};

Image<float> even(Size size, std::vector<float> values) {
  Image<float> image(size, static_cast<int>(values.size()));
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < size.height; ++y)
      std::fill_n(image.plane(p).row(y), size.width, values[static_cast<std::size_t>(p)]);
  }
  return image;
}

/// A folder of maps that are alike everywhere.
class EvenMaps {
 public:
  EvenMaps(Vec3 normal, std::vector<float> albedo) {
    write("normal", {"X", "Y", "Z"}, {float(normal.x), float(normal.y), float(normal.z)});
    write("albedo", {"R", "G", "B"}, std::move(albedo));
  }

  std::unique_ptr<Pyramid> open(const Layer& layer) const {
    Result<std::unique_ptr<Pyramid>> pyramid = Pyramid::open(folder_.path(), layer, folder_.path() / "kept");
    EXPECT_TRUE(pyramid) << pyramid.error().message();
    return std::move(*pyramid);
  }
  std::unique_ptr<Pyramid> normal() const {
    return open({"normal", LayerKind::kNormal, "", "normal.exr", {"X", "Y", "Z"}, false});
  }
  std::unique_ptr<Pyramid> albedo() const {
    return open({"albedo", LayerKind::kColor, "share", "albedo.exr", {"R", "G", "B"}, false});
  }

 private:
  void write(const std::string& name, const std::vector<std::string>& channels, std::vector<float> values) {
    const Image<float> image = even(kMaps, std::move(values));
    WriteOptions options;
    options.type = SampleType::kFloat;
    const std::vector<View<const float>> planes = {image.plane(0), image.plane(1), image.plane(2)};
    const Result<void> written = write_image(folder_.path() / (name + ".exr"), planes, channels, options);
    ASSERT_TRUE(written) << written.error().message();
  }

  TemporaryFolder folder_;
};

constexpr double kRadians = std::numbers::pi / 180;

// The lamp stands 45 degrees high: a plane that leans t towards it has cos(45 - t) of its light, over what a
// level one has, beside the 0.15 that come from everywhere.
TEST(Swatch, ShadesATiltedPlaneAsItsAngleToTheLampSays) {
  for (const double tilt : {0.0, 10.0, 30.0, -20.0}) {
    const double across = std::sin(tilt * kRadians) / std::numbers::sqrt2;
    const EvenMaps maps({-across, across, std::cos(tilt * kRadians)}, {0.2F, 0.4F, 0.1F});
    const Result<Image<float>> picture =
        swatch_picture(*maps.normal(), *maps.albedo(), {10, 20, 410, 220}, false);
    ASSERT_TRUE(picture) << picture.error().message();
    const double shade = 0.15 + 0.85 * std::cos((45 - tilt) * kRadians) / std::cos(45 * kRadians);
    for (int p = 0; p < 3; ++p) {
      const double albedo = std::vector{0.2, 0.4, 0.1}[static_cast<std::size_t>(p)];
      const float expected = report::srgb_from_linear(static_cast<float>(shade * albedo));
      EXPECT_NEAR((*picture)(3, 5, p), expected, 1e-5) << tilt << " degrees, channel " << p;
    }
    EXPECT_EQ(picture->size(), (Size{200, 100})) << "squares of two pixels: 400 are more than 320";
  }
}

TEST(Swatch, IsTheLargestSquareWhereNothingLiesBeside) {
  EXPECT_EQ(swatch_part({.size = kMaps}, {}), (Rect{100, 0, 500, 400}));
}

TEST(Swatch, ShowsSixtyMillimetresOfALargerCloth) {
  EXPECT_EQ(swatch_part({.size = kMaps, .mm_per_pixel = 0.5}, {}), (Rect{240, 140, 360, 260}));
}

// A tag that begins 150 pixels right of the middle leaves 150 to either side.
TEST(Swatch, EndsBeforeATag) {
  EXPECT_EQ(swatch_part({.size = kMaps, .beside = {{450, 20, 500, 60}}}, {}), (Rect{150, 50, 450, 350}));
}

// A cloth of 200 x 200 pixels in the left of the frame, known to the eighth pixel: its square has it all, and
// of what is no cloth no more than a twentieth.
TEST(Swatch, LiesOnTheClothWhereAMaskLeftTheRestUnsolved) {
  Image<float> sigma = even({75, 50}, {180.0F});
  for (int y = 10; y < 35; ++y) std::fill_n(sigma.plane().row(y) + 5, 25, 0.3F);
  const Rect part = swatch_part({.size = kMaps}, sigma.plane());
  EXPECT_NEAR(0.5 * (part.x0 + part.x1), 140, 1) << part.x0 << " to " << part.x1;
  EXPECT_NEAR(0.5 * (part.y0 + part.y1), 180, 1) << part.y0 << " to " << part.y1;
  EXPECT_GE(part.width(), 200);
  EXPECT_LE(part.width(), 200 / std::sqrt(0.95) + 8);
}

TEST(Swatch, IsNeverSmallerThanAnEighthOfTheFrame) {
  const Rect part = swatch_part({.size = kMaps, .beside = {{250, 150, 350, 250}}}, {});
  EXPECT_EQ(part, (Rect{275, 175, 325, 225})) << "a tag lies in the middle";
}

TEST(Swatches, DrawEachOnceAndKeepTheNewest) {
  const TemporaryFolder folder;
  Swatches swatches(folder.path() / "swatches", 8);
  int drawn = 0;
  const auto draw = [&]() -> Result<Image<float>> {
    ++drawn;
    return even({8, 8}, {0.5F, 0.5F, 0.5F});
  };
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(swatches.find_or("same", draw));
  EXPECT_EQ(drawn, 1);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(swatches.find_or(std::to_string(i), draw));
  const auto files = std::filesystem::directory_iterator(folder.path() / "swatches");
  const auto kept = std::distance(begin(files), end(files));
  EXPECT_GE(kept, 8);
  EXPECT_LE(kept, 9);
}

}  // namespace
}  // namespace weft::app
