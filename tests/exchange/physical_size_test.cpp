// SPDX-License-Identifier: Apache-2.0
// All formats say the same millimetres: each is read back by the few lines that its unit takes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <regex>

#include "core/base/json_document.h"
#include "core/base/temporary_folder.h"
#include "core/image_io/image_io.h"
#include "exchange/gltf/glb.h"
#include "exchange/materialx/materialx.h"
#include "exchange/u3m/u3m.h"
#include "exchange/usd/usd.h"
#include "tests/exchange/sample_material.h"

namespace weft::exchange {
namespace {

using Millimetres = std::array<double, 2>;

struct SizeCase {
  Millimetres size_mm;
  Size pixels;
};

const std::vector<SizeCase> kSizes = {{{8, 8}, {64, 64}},
                                      {{80, 50.9}, {40, 30}},
                                      {{0.731, 1234.5}, {7, 33}},
                                      {{1.0 / 3, 2.0 / 3}, {16, 16}},
                                      {{317.123456, 9.87654321}, {31, 5}}};

SampleMaterial sample_of(const SizeCase& each) {
  SampleOptions options;
  options.size = each.pixels;
  options.size_mm = each.size_mm;
  options.packing = Packing::kSeparate;
  options.has_sheen = options.has_opacity = false;
  return sample_material(options);
}

std::string bytes_of(const Result<Document>& document) {
  EXPECT_TRUE(document) << (document ? "" : document.error().message());
  return document ? document->bytes : std::string();
}

void expect_size(const Millimetres& read, const Millimetres& truth, const char* format) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(read[axis] / truth[axis], 1, 1e-6)
        << format << ", axis " << axis << ": " << read[axis] << " mm";
  }
}

/// The two numbers behind `mark` in a text.
Millimetres numbers_behind(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark);
  EXPECT_NE(at, std::string::npos) << mark;
  if (at == std::string::npos) return {};
  char* end = nullptr;
  const double first = std::strtod(text.c_str() + at + mark.size(), &end);
  return {first, std::strtod(end + 1, nullptr)};
}

TEST(PhysicalSize, OfGltfIsThatOfItsCorners) {
  for (const SizeCase& each : kSizes) {
    for (const std::array<int, 2> tiles : {std::array{1, 1}, std::array{3, 7}}) {
      const std::string glb = bytes_of(glb_of(
          [&] {
            TexturedMaterial material = constant_material();
            material.size_mm = each.size_mm;
            return material;
          }(),
          {}, {tiles, AlphaMode::kMask}));
      std::uint32_t text_bytes = 0;
      std::memcpy(&text_bytes, glb.data() + 12, 4);
      const Json asset = Json::parse(glb.substr(20, text_bytes));
      const Json& view = asset["bufferViews"][0];
      std::array<float, 12> corners = {};
      std::memcpy(corners.data(), glb.data() + 28 + text_bytes + view["byteOffset"].get<std::size_t>(), 48);
      const Millimetres read = {(double{corners[6]} - corners[0]) * 1000 / tiles[0],
                                (double{corners[7]} - corners[1]) * 1000 / tiles[1]};
      expect_size(read, each.size_mm, "glTF");
    }
  }
}

TEST(PhysicalSize, OfUsdIsThatOfItsPointsAndCoordinates) {
  for (const SizeCase& each : kSizes) {
    const std::string usda = bytes_of(usda_of(sample_of(each).material, {{3, 7}, ""}));
    const Millimetres corner = numbers_behind(usda, "point3f[] points = [(");
    const Millimetres metres_per_unit = numbers_behind(usda, "metersPerUnit = ");
    const double millimetres = metres_per_unit[0] * 1000;
    expect_size({-2 * corner[0] * millimetres / 3, -2 * corner[1] * millimetres / 7}, each.size_mm, "USD");
  }
}

TEST(PhysicalSize, OfMaterialXIsThatOfItsImages) {
  for (const SizeCase& each : kSizes) {
    const std::string text = bytes_of(materialx_of(sample_of(each).material));
    const Millimetres metres =
        numbers_behind(text, "<input name=\"realworldimagesize\" type=\"vector2\" value=\"");
    EXPECT_THAT(text, testing::HasSubstr("unit=\"meter\""));
    expect_size({metres[0] * 1000, metres[1] * 1000}, each.size_mm, "MaterialX");
  }
}

TEST(PhysicalSize, OfU3mIsThatOfItsPixelsAndDotsPerInch) {
  for (const SizeCase& each : kSizes) {
    U3mOptions options;
    options.created = options.modified = "2026-11-21T14:25:01Z";
    options.digest = std::string(64, '0');
    const Json document = Json::parse(bytes_of(u3m_of(sample_of(each).material, options)));
    const Json& image = document["material"]["front"]["normal"]["texture"]["image"];
    expect_size({image["width"], image["height"]}, each.size_mm, "U3M");
    expect_size({each.pixels.width / image["dpi"]["x"].get<double>() * 25.4,
                 each.pixels.height / image["dpi"]["y"].get<double>() * 25.4},
                each.size_mm, "U3M by dots per inch");
  }
}

// A PNG has whole pixels a metre: of sizes that are none it is the nearest. A TIFF has one an inch at least.
TEST(PhysicalSize, OfImagesIsThatOfTheirPixels) {
  const TemporaryFolder folder;
  for (const SizeCase& each : kSizes) {
    const Image<float> image(each.pixels);
    const std::array<View<const float>, 1> planes = {image.plane()};
    const PixelPitch pitch_mm = {each.size_mm[0] / each.pixels.width, each.size_mm[1] / each.pixels.height};
    for (const char* name : {"a.exr", "a.tif", "a.png"}) {
      const bool is_png = std::string(name) == "a.png", is_tiff = std::string(name) == "a.tif";
      if (is_tiff && std::max(pitch_mm[0], pitch_mm[1]) > 25.4) continue;
      const SampleType type = is_png ? SampleType::kUint8 : SampleType::kFloat;
      ASSERT_TRUE(write_image(folder.path() / name, planes, {"Y"}, {.type = type, .pitch_mm = pitch_mm}));
      const auto info = read_image_info(folder.path() / name);
      ASSERT_TRUE(info) << info.error().message();
      Millimetres wanted = each.size_mm;
      for (std::size_t axis = 0; is_png && axis < 2; ++axis)
        wanted[axis] *= 1000 / pitch_mm[axis] / std::max(1.0, std::round(1000 / pitch_mm[axis]));
      expect_size({info->pitch_mm[0] * each.pixels.width, info->pitch_mm[1] * each.pixels.height}, wanted,
                  name);
    }
  }
}

}  // namespace
}  // namespace weft::exchange
