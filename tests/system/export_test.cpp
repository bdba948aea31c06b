// SPDX-License-Identifier: Apache-2.0
// The chain from photographs to files that other programs open, by the job and by the program.
#include "exchange/export/export.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/image/color_spaces.h"
#include "core/image_io/image_io.h"
#include "exchange/blocks/dds.h"
#include "exchange/blocks/decode_blocks.h"
#include "exchange/export/preset_files.h"
#include "exchange/presets/preset.h"
#include "material/run/maps.h"
#include "solve/run/solve_session.h"
#include "tests/exchange/export_checks.h"
#include "tests/system/program.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using exchange::export_maps;
using exchange::ExportOptions;
using exchange::ExportReport;
using testing::HasSubstr;

std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const exchange::ShippedPreset& preset : exchange::shipped_presets()) names.emplace_back(preset.name);
  return names;
}

/// One small session with a set of all maps, made once for all tests.
class Exports : public testing::Test {
 protected:
  // A workspace has the name of a running test: the first one makes it.
  void SetUp() override {
    if (work_ == nullptr) {
      ASSERT_NO_FATAL_FAILURE(make_maps());
    }
  }
  static void make_maps() {
    work_ = new Workspace();
    session_ = *work_ / "cloth.weft";
    simulate(scene_named("twill", {192, 128}), session_);
    solve::SolveOptions solve;
    solve.method = "fast";
    solve.previews = false;
    const auto solved = solve::solve_session({.folder = session_, .calibration = {}, .leds = {}}, solve, {});
    ASSERT_TRUE(solved) << solved.error().message();
    material::MapsOptions maps;
    maps.session = session_;
    for (const material::DerivedMap& map : material::derived_maps()) maps.maps.emplace_back(map.name);
    const auto made = weft::material::make_maps(maps, {});
    ASSERT_TRUE(made) << made.error().message();
    maps_ = made->folder;
    mm_per_pixel_ = made->facts.mm_per_pixel;
  }
  static void TearDownTestSuite() {
    delete work_;
    work_ = nullptr;
  }

  static std::vector<ExportReport> exported(const std::vector<std::string>& presets, const fs::path& output,
                                            int threads = 0) {
    ExportOptions options = {.input = session_};
    options.presets = presets;
    options.output = output;
    const auto reports = export_maps(options, {.threads = threads, .stop = {}});
    EXPECT_TRUE(reports) << reports.error().message();
    return reports ? *reports : std::vector<ExportReport>();
  }

  static LoadedImage map_file(const std::string& name) {
    auto image = read_image(maps_ / name);
    EXPECT_TRUE(image) << image.error().message();
    return image ? std::move(*image) : LoadedImage();
  }

  static inline Workspace* work_ = nullptr;
  static inline fs::path session_, maps_;
  static inline double mm_per_pixel_ = 0;
};

TEST_F(Exports, OfEveryPresetAreTheSameBytesTwiceAndForAnyThreads) {
  const std::vector<ExportReport> one = exported(shipped_names(), *work_ / "one", 1);
  ASSERT_EQ(one.size(), shipped_names().size());
  exported(shipped_names(), *work_ / "two", 3);
  EXPECT_EQ(contents_of(*work_ / "one"), contents_of(*work_ / "two"));
  for (const ExportReport& report : one) {
    EXPECT_FALSE(report.was_there);
    for (const Json& file : Json(json_of(report.facts)["files"])) {
      if (file.contains("inside")) continue;
      const fs::path path = report.folder / file["file"].get<std::string>();
      const auto digest = sha256_of_file(path);
      ASSERT_TRUE(digest) << digest.error().message();
      EXPECT_EQ(*digest, file["sha256"].get<std::string>()) << path;
      EXPECT_EQ(fs::file_size(path), file["bytes"].get<std::uintmax_t>()) << path;
    }
  }
}

// The value of a channel, computed from the maps' own files.
double truth_of(const std::string& channel, const std::map<std::string, LoadedImage>& maps, int x, int y,
                bool is_directx) {
  const auto at = [&](const char* file, const char* plane) {
    return static_cast<double>(maps.at(file).channel(plane)(x, y));
  };
  if (channel == "albedo.r") return at("albedo.exr", "R");
  if (channel == "albedo.g") return at("albedo.exr", "G");
  if (channel == "albedo.b") return at("albedo.exr", "B");
  if (channel == "normal.x") return at("normal.exr", "X");
  if (channel == "normal.y") return (is_directx ? -1 : 1) * at("normal.exr", "Y");
  if (channel == "normal.z") return at("normal.exr", "Z");
  if (channel == "height") return at("height.exr", "height");
  if (channel == "occlusion") return at("occlusion.exr", "openness");
  if (channel == "metallic" || channel == "zero") return 0;
  if (channel == "opacity" || channel == "one") return 1;
  return NAN;
}

TEST_F(Exports, HoldTheMapsWithinHalfAStepOfTheirQuantiser) {
  std::map<std::string, LoadedImage> maps;
  for (const char* file : {"albedo.exr", "normal.exr", "height.exr", "occlusion.exr"})
    maps[file] = map_file(file);
  const std::vector<std::string> presets = {"png16", "tiff16", "polyhaven", "unreal", "unity-hdrp", "godot"};
  int compared = 0;
  for (const ExportReport& report : exported(presets, *work_ / "half")) {
    for (const Json& file : Json(json_of(report.facts)["files"])) {
      const fs::path path = report.folder / file["file"].get<std::string>();
      const auto image = read_image(path);
      ASSERT_TRUE(image) << image.error().message();
      const double steps = image->info.type == SampleType::kUint16 ? 65535 : 255;
      const bool is_directx = file.value("direction", "opengl") == "directx";
      for (std::size_t c = 0; c < file["channels"].size(); ++c) {
        const Json& channel = file["channels"][c];
        const std::string name = channel["name"].get<std::string>();
        const double least = channel["at_0"].get<double>(), most = channel["at_1"].get<double>();
        for (const auto& [x, y] : std::vector<std::pair<int, int>>{{3, 5}, {64, 32}, {100, 90}, {150, 17}}) {
          double wanted = (truth_of(name, maps, x, y, is_directx) - least) / (most - least);
          if (std::isnan(wanted)) continue;
          wanted = std::min(1.0, std::max(0.0, wanted));
          if (file["color"] == "srgb" && name.starts_with("albedo"))
            wanted = srgb_of_rec709({wanted, wanted, wanted})[0];
          EXPECT_NEAR(image->planes(x, y, static_cast<int>(c)), wanted, 0.501 / steps) << path << " " << name;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 200);
}

TEST_F(Exports, SayWhatTheyAreWhatTheyLoseAndWhereTheyComeFrom) {
  const Json document = json_of(exported({"unreal"}, *work_ / "said")[0].facts);
  EXPECT_EQ(document["schema"], "weft.export/1");
  EXPECT_EQ(document["roughness"], "root");
  EXPECT_DOUBLE_EQ(document["mm_per_pixel"].get<double>(), mm_per_pixel_);
  const Json& from = document["from"];
  EXPECT_EQ(from["maps"], maps_.filename().string());
  EXPECT_FALSE(from["solve"].get<std::string>().empty());
  ASSERT_EQ(from["raws"].size(), 11U) << "ten LEDs and the dark";
  EXPECT_EQ(from["raws"][0]["sha256"].get<std::string>().size(), 64U);
  const Json& normal = document["files"][1];
  EXPECT_EQ(normal["direction"], "directx");
  EXPECT_NEAR(normal["lost"]["normal_deg"]["mean"].get<double>(), 0.18, 0.04) << "eight bits";
  EXPECT_LT(normal["lost"]["normal_deg"]["max"].get<double>(), 0.5);
  EXPECT_GT(document["files"][0]["lost"]["albedo"]["psnr_db"].get<double>(), 55);
  for (const Json& file : document["files"]) {
    for (const Json& channel : file["channels"]) {
      const double half = 0.5 * (channel["at_1"].get<double>() - channel["at_0"].get<double>()) / 255;
      if (file["color"] == "data") {
        EXPECT_LE(channel["lost"]["max"].get<double>(), 1.001 * half)
            << file["file"] << " " << channel.dump();
      }
    }
  }
}

TEST_F(Exports, CarryTheSizeOfTheirPixels) {
  for (const ExportReport& report : exported({"exr", "png16", "tiff16"}, *work_ / "sized")) {
    for (const Json& file : Json(json_of(report.facts)["files"])) {
      const auto info = read_image_info(report.folder / file["file"].get<std::string>());
      ASSERT_TRUE(info) << info.error().message();
      // A PNG has whole pixels a metre.
      const double tolerance = info->format == "png" ? 0.51 * mm_per_pixel_ / 1000 : 1e-6;
      EXPECT_NEAR(info->pitch_mm[0] / mm_per_pixel_, 1, tolerance) << file["file"];
      EXPECT_NEAR(info->pitch_mm[1] / mm_per_pixel_, 1, tolerance) << file["file"];
      const bool is_colour = file["file"].get<std::string>().find("albedo") != std::string::npos;
      if (info->format == "png") {
        EXPECT_EQ(info->color, is_colour ? ColorSpace::kSrgb : ColorSpace::kData) << file["file"];
      }
      if (info->format == "openexr") {
        EXPECT_EQ(info->color, is_colour ? ColorSpace::kLinearColor : ColorSpace::kData) << file["file"];
      }
    }
  }
  for (const char* map : {"normal.exr", "albedo.exr", "height.exr", "occlusion.exr"}) {
    const auto info = read_image_info(maps_ / map);
    ASSERT_TRUE(info);
    EXPECT_NEAR(info->pitch_mm[0] / mm_per_pixel_, 1, 1e-6) << map;
  }
}

TEST_F(Exports, OfASmallerSizeKeepTheMillimetres) {
  ExportOptions options = {.input = session_};
  options.presets = {"png16"};
  options.output = *work_ / "small";
  options.size_px = 50;
  const auto reports = export_maps(options, {});
  ASSERT_TRUE(reports) << reports.error().message();
  const Json d = json_of((*reports)[0].facts);
  EXPECT_EQ(d["width"], 50);
  const LoadedImage normal = map_file("normal.exr");
  EXPECT_NEAR(d["size_mm"][0].get<double>() / (normal.info.size.width * mm_per_pixel_), 1, 1e-9);
  EXPECT_NEAR(d["size_mm"][1].get<double>() / (normal.info.size.height * mm_per_pixel_), 1, 1e-9);
  expect_refusal(*work_, {"export", session_.string(), "--preset", "png16", "--size", "100000", "-q"}, 65,
                 {"--size", "100000 pixels are asked for"});
}

// Alphas of a level of a set's own mips: their geometric mean, row by row.
std::vector<double> own_alphas(const fs::path& maps, int level) {
  const auto lobe = read_image(maps / fmt::format("mips/lobe_{:02}.exr", level));
  EXPECT_TRUE(lobe) << lobe.error().message();
  std::vector<double> alphas;
  for (int y = 0; lobe && y < lobe->info.size.height; ++y) {
    for (int x = 0; x < lobe->info.size.width; ++x)
      alphas.push_back(std::sqrt(static_cast<double>(lobe->planes(x, y, 0) * lobe->planes(x, y, 1))));
  }
  return alphas;
}

// And of a channel of a file's level, whose values are `value` of the samples.
template <typename Value>
std::vector<double> alphas_of(const Image<float>& level, int channel, const Value& value) {
  std::vector<double> alphas;
  for (int y = 0; y < level.height(); ++y) {
    for (int x = 0; x < level.width(); ++x)
      alphas.push_back(value(static_cast<double>(level(x, y, channel))));
  }
  return alphas;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// As OpenImageIO's own program reads it.
Image<float> level_of_tx(const fs::path& file, int level) {
  const fs::path alone = file.parent_path().parent_path() / "level.exr";
  const std::string command =
      fmt::format("oiiotool '{}' --selectmip {} -o '{}'", file.string(), level, alone.string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  auto image = read_image(alone);
  EXPECT_TRUE(image) << image.error().message();
  return image ? std::move(image->planes) : Image<float>();
}

/// A set of the same session whose lobe is narrow, so that the spread of normals matters.
class GlossyExports : public Exports {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(Exports::SetUp());
    if (!glossy_.empty()) return;
    material::MapsOptions maps;
    maps.session = session_;
    maps.maps = {"occlusion", "roughness", "mips"};
    maps.derive.cloth = "satin";
    maps.output = *work_ / "glossy";
    const auto made = weft::material::make_maps(maps, {});
    ASSERT_TRUE(made) << made.error().message();
    glossy_ = made->folder;
  }
  static ExportReport glossy(const std::string& preset, int size_px = 0) {
    ExportOptions options = {.input = glossy_, .presets = {preset}, .name = "satin"};
    options.output = *work_ / fmt::format("glossy_{}_{}", preset, size_px);
    options.size_px = size_px;
    const auto reports = export_maps(options, {});
    EXPECT_TRUE(reports) << reports.error().message();
    return reports ? (*reports)[0] : ExportReport();
  }
  static void TearDownTestSuite() {
    glossy_.clear();
    Exports::TearDownTestSuite();
  }
  static inline fs::path glossy_;
};

TEST_F(GlossyExports, HaveMipsOfRoughnessThatAreTheSetsOwn) {
  const fs::path arnold = glossy("arnold").folder, order = glossy("order1886").folder,
                 blocks = glossy("dds").folder;
  const auto square = [](double root) { return root * root; };
  const auto itself = [](double alpha) { return alpha; };
  const auto parameters = exchange::parse_dds(bytes_of(order / "satin_parameters.dds"), "parameters");
  const auto orm = exchange::parse_dds(bytes_of(blocks / "satin_orm.dds"), "orm");
  ASSERT_TRUE(parameters && orm);
  const double finest = mean_of(alphas_of(level_of_tx(arnold / "satin_roughness.tx", 0), 0, square));
  for (const int level : {1, 2, 3, 4}) {
    const std::vector<double> own = own_alphas(glossy_, level);
    EXPECT_GT(mean_of(own), 1.03 * finest) << "level " << level << ": nothing to lose";
    const std::vector<double> tx = alphas_of(level_of_tx(arnold / "satin_roughness.tx", level), 0, square);
    ASSERT_EQ(tx.size(), own.size());
    for (std::size_t i = 0; i < own.size(); ++i)
      ASSERT_NEAR(tx[i] / own[i], 1, 0.02) << "level " << level << ", texel " << i << " of " << own.size();
    for (const auto* texture : {&*parameters, &*orm}) {
      const Size size = exchange::level_size(texture->size, level);
      const auto read =
          exchange::decode_blocks(texture->format, texture->levels[static_cast<std::size_t>(level)], size, 1);
      ASSERT_TRUE(read) << read.error().message();
      const double mean =
          texture == &*orm ? mean_of(alphas_of(*read, 1, square)) : mean_of(alphas_of(*read, 0, itself));
      EXPECT_NEAR(mean / mean_of(own), 1, 0.02) << "level " << level;
    }
  }
}

TEST_F(GlossyExports, OfOneLevelSayWhatRoughnessLosesByDistance) {
  const ExportReport report = glossy("png16");
  const Json* roughness = nullptr;
  const Json document = json_of(report.facts);
  for (const Json& file : document["files"]) {
    if (file["channels"][0]["name"] == "roughness") roughness = &file;
  }
  ASSERT_NE(roughness, nullptr);
  const Json& levels = (*roughness)["lost"]["by_distance"];
  ASSERT_GE(levels.size(), 3U) << roughness->dump();
  for (const Json& level : levels) {
    std::vector<double> roots;
    for (const double alpha : own_alphas(glossy_, level["level"].get<int>()))
      roots.push_back(std::sqrt(alpha));
    EXPECT_NEAR(level["mean"].get<double>(), mean_of(roots), 0.002) << level.dump();
    EXPECT_LT(level["engine"].get<double>(), level["mean"].get<double>()) << level.dump();
    EXPECT_GE(level["lost"].get<double>(),
              0.999 * (level["mean"].get<double>() - level["engine"].get<double>()));
  }
  EXPECT_THAT(document["notes"].dump(), HasSubstr("Seen from 8 times as far"));
  const ExportReport with_mips = glossy("arnold");
  EXPECT_THAT(Json(with_mips.facts.notes).dump(), testing::Not(HasSubstr("times as far")));
}

TEST_F(Exports, HaveContainersThatTheirOwnCheckersTake) {
  const std::vector<ExportReport> reports = exported({"glb", "usdz", "u3m", "u3ma", "dds"}, *work_ / "boxes");
  ASSERT_EQ(reports.size(), 5U);
  const auto bytes = [&](std::size_t i) {
    return bytes_of(reports[i].folder / reports[i].facts.documents.at(0).name);
  };
  const auto good = [](const Result<void>& checked) { return checked ? "" : checked.error().message(); };
  EXPECT_EQ(good(exchange::check_glb(bytes(0))), "");
  EXPECT_EQ(good(exchange::check_zip(bytes(1), exchange::ZipKind::kAligned)), "");
  EXPECT_EQ(good(exchange::check_u3m(bytes(2))), "");
  EXPECT_EQ(good(exchange::check_zip(bytes(3), exchange::ZipKind::kStrict)), "");
  for (const std::size_t container : {0U, 1U, 3U}) {
    std::vector<std::string> left;
    for (const auto& [name, digest] : contents_of(reports[container].folder)) left.push_back(name);
    EXPECT_EQ(left.size(), 2U) << "the document and export.json: " << testing::PrintToString(left);
  }
  for (const Json& file : Json(json_of(reports[4].facts)["files"])) {
    const std::string dds = bytes_of(reports[4].folder / file["file"].get<std::string>());
    const auto texture = exchange::parse_dds(dds, "dds");
    ASSERT_TRUE(texture) << texture.error().message();
    EXPECT_EQ(static_cast<int>(texture->levels.size()), file["levels"].get<int>());
    EXPECT_EQ(texture->size.width % 4, 0);
    EXPECT_EQ(exchange::level_size(texture->size, file["levels"].get<int>() - 1), (Size{1, 1}));
  }
}

TEST_F(Exports, InTheirPlaceAreKeptReplacedOrRefused) {
  const auto run = [&](const std::string& name) {
    ExportOptions options = {.input = session_, .presets = {"unreal"}, .name = name};
    return export_maps(options, {});
  };
  const auto first = run("linen"), again = run("linen"), other = run("wool");
  ASSERT_TRUE(first && again && other);
  EXPECT_EQ((*first)[0].folder, session_ / "export" / "unreal");
  EXPECT_TRUE((*again)[0].was_there);
  EXPECT_FALSE((*other)[0].was_there);
  EXPECT_FALSE(fs::exists(session_ / "export" / "unreal" / "T_linen_N.png")) << "the earlier one is gone";
  EXPECT_TRUE(fs::exists(session_ / "export" / "unreal" / "T_wool_N.png"));
  put_bytes(session_ / "export" / "unreal" / "notes.txt", "mine");
  const auto refused = run("silk");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kCannotCreate);
  EXPECT_THAT(refused.error().message(), HasSubstr("notes.txt"));
  fs::remove_all(session_ / "export");
}

TEST_F(Exports, ThatCannotBeAreRefusedBeforeAnythingIsMade) {
  const std::string session = session_.string();
  expect_refusal(*work_, {"export", session, "--preset", "unreel", "-q"}, 66,
                 {"unreel", "nearest is unreal"});
  for (const char* name : {"con", "a/b", "what?", "dot."})
    expect_refusal(*work_, {"export", session, "--preset", "png16", "--name", name, "-q"}, 65,
                   {"--name", name});
  expect_refusal(*work_, {"export", session, "--preset", "png16,png16", "-q"}, 64,
                 {"--preset", "png16 stands twice"});
  const std::string preset =
      "schema = \"weft.preset/1\"\nname = \"mine\"\n[[file]]\nname = \"{name}.png\"\nchannels = [\"cloth\", "
      "\"height\", \"oclusion\"]\n";
  put_bytes(*work_ / "mine.toml", preset);
  expect_refusal(*work_, {"export", session, "--preset", (*work_ / "mine.toml").string(), "-q"}, 65,
                 {"mine.toml: file 1: channels", "nearest is occlusion"});
  expect_refusal(*work_, {"export", (*work_ / "nothing").string(), "--preset", "png16", "-q"}, 66,
                 {"nothing"});
}

TEST_F(Exports, OfMapsThatLackWhatAPresetAsksForSayWhich) {
  const fs::path folder = *work_ / "lacking";
  fs::copy(maps_, folder, fs::copy_options::recursive);
  edit_json(folder / "maps.json", [](Json& d) {
    Json kept = Json::array();
    for (const Json& map : d["maps"]) {
      if (map["name"] != "occlusion") kept.push_back(map);
    }
    d["maps"] = kept;
  });
  expect_refusal(*work_, {"export", folder.string(), "--preset", "unreal", "-q"}, 65,
                 {"preset unreal: T_{name}_ORM.png", "occlusion", "which these maps lack"});
  const Outcome masters =
      run_weft({"export", folder.string(), "--preset", "png16", "-o", (*work_ / "some").string(), "-q"});
  EXPECT_EQ(masters.exit_code, 0) << masters.error << ": optional files are left out";
  EXPECT_FALSE(fs::exists(*work_ / "some" / "lacking_ao.png"));
  fs::remove_all(folder);
  fs::remove_all(*work_ / "some");
}

TEST_F(Exports, OfMapsWithAValueThatIsNoNumberAreRefused) {
  const fs::path folder = *work_ / "broken";
  fs::copy(maps_, folder, fs::copy_options::recursive);
  LoadedImage albedo = map_file("albedo.exr");
  albedo.planes(7, 5, 1) = NAN;
  const std::vector<View<const float>> planes = {albedo.planes.plane(0), albedo.planes.plane(1),
                                                 albedo.planes.plane(2)};
  ASSERT_TRUE(write_image(folder / "albedo.exr", planes, {"R", "G", "B"}, {}));
  expect_refusal(*work_, {"export", folder.string(), "--preset", "exr", "-q"}, 65,
                 {"albedo.exr", "G of pixel 7, 5 is no finite number"});
  fs::remove_all(folder);
}

TEST_F(Exports, OnADiskThatFillsUpLeaveNothing) {
  for (const std::uint64_t bytes : {1024U, 60000U}) {
    expect_refusal(*work_,
                   {"export", session_.string(), "--preset", "png16,dds,glb,arnold", "-o",
                    (*work_ / "full").string(), "-q"},
                   74, {"cannot write", "File too large"}, {.largest_file_bytes = bytes});
  }
}

TEST_F(Exports, OfPhotographsWithoutMillimetresInventNoSize) {
  PhotographSample sample;
  sample.size = {16, 12};
  sample.write(*work_ / "photos");
  const fs::path solve = *work_ / "solved";
  const Outcome solved =
      run_weft({"solve", "--photos", (*work_ / "photos").string(), "-o", solve.string(), "-q"});
  ASSERT_EQ(solved.exit_code, 0) << solved.error;
  const Outcome outcome = run_weft(
      {"export", solve.string(), "--preset", "png16", "--json", "-q", "-o", (*work_ / "plain").string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const Json d = outcome.json()["exports"][0];
  EXPECT_EQ(d["size_known"], false);
  EXPECT_EQ(d["albedo_scale"], "relative");
  EXPECT_THAT(d["notes"].dump(),
              testing::AllOf(HasSubstr("size is not known"), HasSubstr("albedo is relative")));
  const auto info = read_image_info(*work_ / "plain" / "solved_albedo.png");
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->pitch_mm, PixelPitch());
  fs::remove_all(*work_ / "plain");
}

TEST_F(Exports, ArePricedBeforeTheyAreMadeAndChooseTheirBits) {
  const Outcome priced =
      run_weft({"export", session_.string(), "--preset", "glb", "--explain", "--json", "-q"});
  ASSERT_EQ(priced.exit_code, 0) << priced.error;
  EXPECT_FALSE(fs::exists(session_ / "export"));
  std::map<std::string, double> deg;
  const Json prices = priced.json();
  for (const Json& row : prices["rows"]) {
    if (row["file"] == "normals")
      deg[row["encoding"].get<std::string>()] = row["lost"]["normal_deg"]["mean"].get<double>();
  }
  EXPECT_NEAR(deg["png, 8 bits"], 0.18, 0.04);
  EXPECT_LT(deg["png, 16 bits"], 0.001);
  EXPECT_GT(deg["dds, bc5"], deg["png, 8 bits"]);
  const Outcome chosen = run_weft({"export", session_.string(), "--preset", "unreal", "--to", "0.1", "--json",
                                   "-q", "-o", (*work_ / "chosen").string()});
  ASSERT_EQ(chosen.exit_code, 0) << chosen.error;
  EXPECT_EQ(chosen.json()["exports"][0]["files"][1]["encoding"], "png, 16 bits");
  expect_refusal(*work_, {"export", session_.string(), "--preset", "dds", "--to", "0.01", "-q"}, 65,
                 {"--to", "dds, bc5"});
  fs::remove_all(*work_ / "chosen");
}

TEST_F(Exports, ChooseTheBestBitsThatAreWrittenInTime) {
  const std::vector<std::string> asked = {"export",    session_.string(), "--preset", "unreal",
                                          "--explain", "--json",          "-q",       "--within"};
  const auto within = [&](const std::string& seconds) {
    std::vector<std::string> words = asked;
    words.push_back(seconds);
    return run_weft(words);
  };
  const Outcome unhurried = within("1000");
  ASSERT_EQ(unhurried.exit_code, 0) << unhurried.error;
  int chosen = 0;
  const Json prices = unhurried.json();
  for (const Json& row : prices["rows"]) {
    if (!row["chosen"].get<bool>()) continue;
    ++chosen;
    EXPECT_EQ(row["encoding"], "png, 16 bits") << row;
  }
  EXPECT_EQ(chosen, 1);
  const Outcome hurried = within("1e-9");
  EXPECT_EQ(hurried.exit_code, 64);
  EXPECT_THAT(hurried.output, testing::AllOf(testing::HasSubstr("cannot be written so quickly"),
                                             testing::HasSubstr("--size")));
}

TEST_F(Exports, ListAndShowTheirPresets) {
  const Outcome listed = run_weft({"export", "--list"});
  ASSERT_EQ(listed.exit_code, 0) << listed.error;
  for (const std::string& name : shipped_names()) EXPECT_THAT(listed.output, HasSubstr(name));
  const Outcome shown = run_weft({"export", "--show", "unity-hdrp"});
  EXPECT_THAT(shown.output, HasSubstr("_MaskMap.png"));
}

}  // namespace
}  // namespace weft::test
