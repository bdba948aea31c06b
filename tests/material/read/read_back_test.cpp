// SPDX-License-Identifier: Apache-2.0
// What weft exports is read by weft as what it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/base/temporary_folder.h"
#include "core/image_io/linear_image.h"
#include "exchange/presets/preset.h"
#include "material/assets/map_set.h"
#include "material/read/compare.h"
#include "tests/material/read/small_set.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

// A texture of an export, with what export.json says that it lost of the maps: the bound for what is read
// back.
struct ExportedFile {
  fs::path path;
  std::map<std::string, double> most_lost = {}, mean_lost = {};  ///< by channel
  double normal_deg = 0;                                         ///< mean

  bool has(const std::string& channel) const { return most_lost.contains(channel); }
};

constexpr double kRounding = 2e-6;    // of floats on the way
constexpr double kLeastAlbedo = 0.1;  // of small_albedo()

std::vector<ExportedFile> files_in(const fs::path& folder) {
  const Result<Json> document = read_json(folder / "export.json", "weft.export", 1);
  EXPECT_TRUE(document) << document.error().message();
  std::vector<ExportedFile> files;
  for (const Json& file : (*document)["files"]) {
    if (file.contains("inside")) continue;
    ExportedFile one = {.path = folder / file["file"].get<std::string>()};
    for (const Json& channel : file["channels"]) {
      const std::string name = channel["name"].get<std::string>();
      one.most_lost[name] = channel["lost"]["max"].get<double>();
      one.mean_lost[name] = channel["lost"]["mean"].get<double>();
      EXPECT_LT(one.most_lost[name], 0.3) << one.path << ", " << name;
    }
    if (file["lost"].contains("normal_deg"))
      one.normal_deg = file["lost"]["normal_deg"]["mean"].get<double>();
    EXPECT_LT(one.normal_deg, 2) << one.path;
    files.push_back(std::move(one));
  }
  return files;
}

// All presets of one set, exported once.
class ReadBack : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    SmallSet().write(set());
    for (const exchange::ShippedPreset& preset : exchange::shipped_presets())
      exported_small(set(), preset.name, folder_->path());
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static fs::path set() { return folder_->path() / "set"; }

  static std::vector<ExportedFile> all_files() {
    std::vector<ExportedFile> all;
    for (const exchange::ShippedPreset& preset : exchange::shipped_presets()) {
      for (ExportedFile& file : files_in(folder_->path() / preset.name)) all.push_back(std::move(file));
    }
    return all;
  }

  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(ReadBack, CompareTakesEachFileOfEachPresetForWhatItIs) {
  int normals = 0, albedos = 0, heights = 0, shares = 0;
  for (const ExportedFile& file : all_files()) {
    const auto against = [&](const char* map) {
      const Result<MapComparison> compared = compare_maps(file.path, set() / map, {});
      EXPECT_TRUE(compared) << file.path << ": " << compared.error().message();
      return compared ? *compared : MapComparison(std::vector<NumberComparison>());
    };
    if (file.has("normal.x")) {
      const MapComparison compared = against("normal.exr");
      ASSERT_TRUE(std::holds_alternative<solve::NormalComparison>(compared)) << file.path;
      EXPECT_LT(std::get<solve::NormalComparison>(compared).mean_deg, 1.01 * file.normal_deg + 1e-3)
          << file.path;
      ++normals;
    }
    if (file.has("albedo.r")) {
      const MapComparison compared = against("albedo.exr");
      ASSERT_TRUE(std::holds_alternative<AlbedoComparison>(compared)) << file.path;
      const double mean = std::max(
          {file.mean_lost.at("albedo.r"), file.mean_lost.at("albedo.g"), file.mean_lost.at("albedo.b")});
      EXPECT_LT(std::get<AlbedoComparison>(compared).mean_rel, mean / kLeastAlbedo + kRounding) << file.path;
      ++albedos;
    }
    for (const auto& [channel, map] :
         {std::pair{"height", "height.exr"}, std::pair{"occlusion", "occlusion.exr"}}) {
      if (!file.has(channel)) continue;
      const MapComparison compared = against(map);
      const auto* numbers = std::get_if<std::vector<NumberComparison>>(&compared);
      ASSERT_TRUE(numbers != nullptr && numbers->size() == 1) << file.path;
      EXPECT_EQ(numbers->front().name, channel);
      EXPECT_LT(numbers->front().max_abs, file.most_lost.at(channel) + kRounding) << file.path;
      ++(std::string(channel) == "height" ? heights : shares);
    }
  }
  EXPECT_GE(normals, 20);
  EXPECT_GE(albedos, 19);
  EXPECT_GE(heights, 17);
  EXPECT_GE(shares, 12);
}

// The value of a parameter where the set has it.
double truth_of(Parameter parameter, int x, int y, int plane) {
  using enum Parameter;
  const std::array<double, 3> n = small_normal(x, y);
  switch (parameter) {
    case kAlbedo:
      return small_albedo(x, y, plane);
    case kNormal:
      return slopes_of_normal(n[0], n[1], n[2])[static_cast<std::size_t>(plane)];
    case kHeight:
      return small_height_mm(x, y);
    case kOcclusion:
      return small_openness(x, y);
    case kRoughness:
      return std::sqrt(small_alpha(x, y));
    case kSpecular:
      return small_f0(x, y) / kF0OfSpecular;
    default:
      return 0;
  }
}

TEST_F(ReadBack, MaterialsTakeEachFileOfEachPresetForWhatItIs) {
  using enum Parameter;
  // How much farther off a parameter may be than its channel: slopes than directions, a root than its square.
  const std::vector<std::tuple<Parameter, std::string, double>> wanted = {
      {kAlbedo, "albedo.r", 1},     {kNormal, "normal.x", 4},       {kHeight, "height", 1},
      {kOcclusion, "occlusion", 1}, {kRoughness, "roughness", 1.2}, {kRoughness, "roughness.least", 1.2},
      {kSpecular, "specular", 1},   {kMetallic, "metallic", 1}};
  std::map<std::string, int> read;
  for (const ExportedFile& file : all_files()) {
    for (const auto& [parameter, channel, factor] : wanted) {
      if (!file.has(channel)) continue;
      const std::string where = file.path.string() + ", " + channel;
      const Result<MapFile> map = find_map(parameter, {{"map", file.path.string()}}, where);
      ASSERT_TRUE(map) << map.error().message();
      const Result<ParameterField> field = read_field(parameter, *map, where);
      ASSERT_TRUE(field) << field.error().message();
      double worst = 0;
      for (int y = 0; y < kSmall.height; ++y) {
        for (int x = 0; x < kSmall.width; ++x) {
          for (int p = 0; p < field->planes; ++p)
            worst = std::max(worst, std::abs(field->at(x, y, p) - truth_of(parameter, x, y, p)));
        }
      }
      double lost = 0;
      const std::string group = channel.substr(0, channel.find('.'));
      for (const auto& [name, most] : file.most_lost) {
        if (name == channel || name.starts_with(group + ".")) lost = std::max(lost, most);
      }
      EXPECT_LT(worst, factor * lost + 5 * kRounding) << where;
      ++read[channel];
    }
  }
  EXPECT_GE(read["normal.x"], 20);
  EXPECT_GE(read["albedo.r"], 19);
  EXPECT_GE(read["height"], 17);
  EXPECT_GE(read["roughness"], 14);
}

TEST_F(ReadBack, MaterialsTakeTheMapsOfAScanInTheirUnits) {
  using enum Parameter;
  for (const auto& [parameter, name] :
       {std::pair{kAlbedo, "albedo"}, std::pair{kNormal, "normal"}, std::pair{kHeight, "height"},
        std::pair{kOcclusion, "occlusion"}, std::pair{kRoughness, "roughness"},
        std::pair{kSpecular, "specular"}}) {
    const auto read = [&](const Json& more) {
      Json value = {{"scan", set().string()}, {"map", name}};
      value.update(more);
      const Result<MapFile> map = find_map(parameter, value, name);
      EXPECT_TRUE(map) << map.error().message();
      return map ? read_field(parameter, *map, name) : map.error();
    };
    const Result<ParameterField> field = read(Json::object());
    ASSERT_TRUE(field) << name << ": " << field.error().message();
    EXPECT_NEAR(field->at(7, 5), truth_of(parameter, 7, 5, 0), 1e-5) << name;
    if (parameter == kNormal) continue;  // its slopes have a strength of their own
    const Result<ParameterField> half = read({{"scale", 0.5}});
    ASSERT_TRUE(half) << name << ": " << half.error().message();
    EXPECT_NEAR(half->at(7, 5), truth_of(parameter, 7, 5, 0) / 2, 1e-5) << name << ", halved";
  }
}

TEST_F(ReadBack, MaterialsScaleWhatIsTheSameAllOverAScanToo) {
  const fs::path alike = folder_->path() / "alike";
  SmallSet().write(alike);
  Result<Json> document = read_json(alike / "maps.json", "weft.maps", 1);
  ASSERT_TRUE(document);
  for (Json& map : (*document)["maps"]) {
    if (map["name"] == "specular") map = {{"name", "specular"}, {"constant", kSmallF0}};
  }
  ASSERT_TRUE(write_json(alike / "maps.json", *document));
  fs::remove(alike / "specular.exr");
  for (const double scale : {1.0, 0.5}) {
    Json value = {{"scan", alike.string()}, {"map", "specular"}};
    if (scale != 1) value["scale"] = scale;
    const Result<MapFile> map = find_map(Parameter::kSpecular, value, "specular");
    ASSERT_TRUE(map) << map.error().message();
    const Result<ParameterField> field = read_field(Parameter::kSpecular, *map, "specular");
    ASSERT_TRUE(field) << field.error().message();
    EXPECT_NEAR(field->at(7, 5), scale * kSmallF0 / kF0OfSpecular, 1e-6) << scale;
  }
}

TEST_F(ReadBack, MaterialsRefuseAFileOfAnotherMap) {
  const fs::path file = folder_->path() / "png16" / "cloth_height.png";
  const Result<MapFile> map = find_map(Parameter::kAlbedo, {{"map", file.string()}}, "m.toml: albedo");
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message(), testing::HasSubstr("cloth_height.png holds height, and no albedo"));
  const auto compared = compare_maps(file, set() / "normal.exr", {});
  ASSERT_FALSE(compared);
  EXPECT_THAT(compared.error().message(), testing::HasSubstr("two kinds"));
}

TEST_F(ReadBack, MaterialsAskForMillimetresWhereNobodySaysThem) {
  const fs::path alone = folder_->path() / "alone";
  fs::create_directories(alone);
  fs::copy_file(folder_->path() / "png16" / "cloth_height.png", alone / "h.png");
  Json value = {{"map", (alone / "h.png").string()}};
  const Result<MapFile> map = find_map(Parameter::kHeight, value, "m.toml: height_mm");
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message(), testing::HasSubstr("say scale"));
  value["scale"] = 0.207;
  value["offset"] = -0.145;
  const Result<MapFile> said = find_map(Parameter::kHeight, value, "m.toml: height_mm");
  ASSERT_TRUE(said) << said.error().message();
  const Result<ParameterField> field = read_field(Parameter::kHeight, *said, "");
  ASSERT_TRUE(field) << field.error().message();
  EXPECT_NEAR(field->at(7, 5), small_height_mm(7, 5), 1e-5);
}

TEST_F(ReadBack, SolvesTakeColoursByTheirTags) {
  for (const char* name : {"png16/cloth_albedo.png", "tiff16/cloth_albedo.tif", "exr/cloth_albedo.exr",
                           "blender/cloth_diff.png"}) {
    const fs::path alone = folder_->path() / ("photo_" + fs::path(name).filename().string());
    fs::copy_file(folder_->path() / name, alone);
    const Result<Image<float>> light = read_linear_image(alone, Transfer::kAuto, Clipped::kKeep);
    ASSERT_TRUE(light) << light.error().message();
    EXPECT_NEAR((*light)(11, 9, 1), small_albedo(11, 9, 1), 0.005) << name;
    const Result<MapComparison> compared = compare_maps(alone, set() / "albedo.exr", {});
    ASSERT_TRUE(compared) << compared.error().message();
    ASSERT_TRUE(std::holds_alternative<AlbedoComparison>(*compared)) << name;
    EXPECT_LT(std::abs(std::get<AlbedoComparison>(*compared).bias_rel), 0.005)
        << name << ", without its export.json";
  }
}

}  // namespace
}  // namespace weft::material
