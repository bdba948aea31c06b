// SPDX-License-Identifier: Apache-2.0
// Maps of other programs, as weft compare and materials find out what they are.
#include "material/read/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/json_document.h"
#include "core/base/temporary_folder.h"
#include "core/image/color_spaces.h"
#include "core/solve/solve_record.h"
#include "material/assets/map_set.h"
#include "tests/material/read/small_set.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

double normal_part(int x, int y, int c) {
  return small_normal(x, y)[static_cast<std::size_t>(c)];
}
double packed_part(int x, int y, int c) {
  return 0.5 + 0.5 * normal_part(x, y, c);
}

class Compare : public testing::Test {
 protected:
  void SetUp() override {
    write_small(file("xyz.exr"), {"X", "Y", "Z"}, normal_part);
    write_small(file("albedo.exr"), {"R", "G", "B"}, small_albedo, {.color = ColorSpace::kLinearColor});
  }
  fs::path file(const std::string& name) const { return folder_.path() / name; }
  Result<MapComparison> compared(const std::string& tested, const std::string& truth) const {
    return compare_maps(file(tested), file(truth), {});
  }
  solve::NormalComparison angles(const std::string& tested) const {
    const Result<MapComparison> both = compared(tested, "xyz.exr");
    EXPECT_TRUE(both) << both.error().message();
    const auto* found = both ? std::get_if<solve::NormalComparison>(&*both) : nullptr;
    EXPECT_NE(found, nullptr) << tested << " is taken for no normals";
    return found ? *found : solve::NormalComparison{.mean_deg = 180};
  }
  /// The most that a slope of a material's normal is off.
  double worst_slope(const std::string& name, Json value = Json::object()) const {
    value["map"] = file(name).string();
    const Result<MapFile> map = find_map(Parameter::kNormal, value, name);
    EXPECT_TRUE(map) << map.error().message();
    if (!map) return 1;
    const Result<ParameterField> field = read_field(Parameter::kNormal, *map, name);
    EXPECT_TRUE(field) << field.error().message();
    if (!field) return 1;
    double worst = 0;
    for (int y = 0; y < kSmall.height; ++y) {
      for (int x = 0; x < kSmall.width; ++x) {
        const auto n = small_normal(x, y);
        const auto slopes = slopes_of_normal(n[0], n[1], n[2]);
        for (int p = 0; p < 2; ++p)
          worst = std::max(worst, std::abs(field->at(x, y, p) - slopes[static_cast<std::size_t>(p)]));
      }
    }
    return worst;
  }
  TemporaryFolder folder_;
};

TEST_F(Compare, CountsNoPixelOfASolveThatIsUnsolved) {
  const auto height = [](int x, int y, int) { return small_height_mm(x, y); };
  const auto with_a_hole = [&](int x, int y, int) { return x < 10 ? 0 : small_height_mm(x, y); };
  fs::create_directories(file("solve"));
  write_small(file("height.exr"), {"height"}, height);
  write_small(file("solve/height.exr"), {"height"}, with_a_hole);
  write_small(file("solve/status.png"), {"Y"},
              [](int x, int, int) { return x < 10 ? static_cast<int>(kNoSolution) / 65535.0 : 0; },
              {.type = SampleType::kUint16});
  ASSERT_TRUE(write_json(file("solve/solve.json"), {{"schema", "weft.solve/1.1"}}));
  const Result<MapComparison> both = compared("solve/height.exr", "height.exr");
  ASSERT_TRUE(both) << both.error().message();
  const auto* numbers = std::get_if<std::vector<NumberComparison>>(&*both);
  ASSERT_TRUE(numbers != nullptr && numbers->size() == 1);
  EXPECT_EQ(numbers->front().pixels, static_cast<std::int64_t>(kSmall.width - 10) * kSmall.height);
  EXPECT_EQ(numbers->front().max_abs, 0);
}

TEST_F(Compare, TellsNormalsOfFloatsFromZeroToOne) {
  write_small(file("a.exr"), {"R", "G", "B"}, packed_part);
  write_small(file("a.tif"), {"R", "G", "B"}, packed_part, {.type = SampleType::kHalf});
  write_small(file("signed.exr"), {"R", "G", "B"}, normal_part);
  for (const char* name : {"a.exr", "a.tif", "signed.exr"}) {
    EXPECT_LT(angles(name).mean_deg, 0.05) << name;
    EXPECT_LT(worst_slope(name), 0.003) << name;
  }
}

TEST_F(Compare, LooksForTheNormalsAmongTheLayersOfAFile) {
  write_small(file("layers.exr"), {"B", "G", "N.X", "N.Y", "N.Z", "R"}, [](int x, int y, int c) {
    return c >= 2 && c <= 4 ? normal_part(x, y, c - 2) : small_albedo(x, y, c == 5 ? 0 : 2 - c);
  });
  EXPECT_LT(angles("layers.exr").max_deg, 1e-3);
  EXPECT_LT(worst_slope("layers.exr"), 1e-5);
  const auto colors = compared("layers.exr", "albedo.exr");
  ASSERT_TRUE(colors) << colors.error().message();
  ASSERT_TRUE(std::holds_alternative<AlbedoComparison>(*colors));
  EXPECT_LT(std::get<AlbedoComparison>(*colors).mean_rel, 1e-6);
}

TEST_F(Compare, HintsAtTheOtherDirectionOfGreen) {
  write_small(file("nor_dx.png"), {"R", "G", "B"},
              [](int x, int y, int c) { return c == 1 ? 1 - packed_part(x, y, c) : packed_part(x, y, c); },
              {.type = SampleType::kUint16});
  const solve::NormalComparison c = angles("nor_dx.png");
  EXPECT_GT(c.mean_deg, 5);
  EXPECT_LT(c.flipped_mean_deg, 0.01);
  EXPECT_LT(worst_slope("nor_dx.png", {{"y", "down"}}), 1e-3);
}

TEST_F(Compare, TakesColoursForColoursByTagsAndNames) {
  const auto shown = [](int x, int y, int c) {
    const double v = small_albedo(x, y, c);
    return srgb_of_rec709({v, v, v})[0];
  };
  write_small(file("tagged.png"), {"R", "G", "B"}, shown,
              {.type = SampleType::kUint16, .color = ColorSpace::kSrgb});
  write_small(file("tagged.tif"), {"R", "G", "B"}, shown,
              {.type = SampleType::kUint16, .color = ColorSpace::kSrgb});
  write_small(file("eight.png"), {"R", "G", "B"}, shown, {.type = SampleType::kUint8});
  write_small(file("x_albedo.exr"), {"R", "G", "B"}, small_albedo);
  for (const char* name : {"tagged.png", "tagged.tif", "eight.png", "x_albedo.exr"}) {
    const auto both = compared(name, "albedo.exr");
    ASSERT_TRUE(both) << name << ": " << both.error().message();
    ASSERT_TRUE(std::holds_alternative<AlbedoComparison>(*both)) << name;
    EXPECT_LT(std::abs(std::get<AlbedoComparison>(*both).bias_rel), 0.002) << name;
  }
}

TEST_F(Compare, RefusesWhereItCannotTellAndWhereTwoMapsAreOfTwoKinds) {
  write_small(file("a.exr"), {"R", "G", "B"}, small_albedo);
  write_small(file("b.exr"), {"R", "G", "B"}, small_albedo);
  const auto unknown = compared("a.exr", "b.exr");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(unknown.error().message(), HasSubstr("say --kind normal or --kind albedo"));
  EXPECT_TRUE(compare_maps(file("a.exr"), file("b.exr"), {}, ComparedKind::kAlbedo));
  const auto other = compared("xyz.exr", "albedo.exr");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message(), HasSubstr("two kinds"));
}

TEST_F(Compare, OfASkyBlueClothIsThatOfItsColours) {
  // As n / 2 + 1/2 this blue is the flat normal.
  const auto blue = [](int, int, int c) { return c == 2 ? 1.0 : 0.5; };
  write_small(file("blue.exr"), {"R", "G", "B"}, blue, {.color = ColorSpace::kLinearColor});
  const auto both = compared("blue.exr", "albedo.exr");
  ASSERT_TRUE(both) << both.error().message();
  EXPECT_TRUE(std::holds_alternative<AlbedoComparison>(*both));
}

TEST_F(Compare, OfOneChannelIsInItsUnit) {
  write_small(file("h.exr"), {"height"}, [](int x, int y, int) { return small_height_mm(x, y); });
  write_small(file("higher.exr"), {"height"}, [](int x, int y, int) { return small_height_mm(x, y) + 0.01; });
  const auto both = compared("higher.exr", "h.exr");
  ASSERT_TRUE(both) << both.error().message();
  const auto* numbers = std::get_if<std::vector<NumberComparison>>(&*both);
  ASSERT_TRUE(numbers && numbers->size() == 1);
  EXPECT_EQ(numbers->front().unit, "mm");
  EXPECT_NEAR(numbers->front().bias, 0.01, 1e-6);
}

}  // namespace
}  // namespace weft::material
