// SPDX-License-Identifier: Apache-2.0
// Photographs under distant lights, from their solve to the files of engines and materials.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "tests/system/program.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

class SolvedPhotographs : public testing::Test {
 protected:
  void SetUp() override {
    PhotographSample sample;
    sample.size = {65, 49};
    sample.write(work_ / "photos");
    const Outcome solved = run("solve --photos photos -o linen -q");
    ASSERT_EQ(solved.exit_code, 0) << solved.error;
  }

  Outcome run(const std::string& words) const {
    std::vector<std::string> arguments;
    std::istringstream line(words);
    for (std::string word; line >> word;) arguments.push_back(word);
    return run_weft(arguments, {.folder = work_.path()});
  }
  Outcome done(const std::string& words) const {
    Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << words << "\n" << outcome.error;
    return outcome;
  }
  Json json_of(const std::string& words) const { return done(words + " --json -q").json(); }
  Json stored(const std::string& file) const {
    const Result<std::string> text = read_text(work_ / file);
    EXPECT_TRUE(text) << text.error().message();
    return text ? Json::parse(*text) : Json();
  }
  std::string text(const fs::path& file) const { return bytes_of(file); }

  Workspace work_;
  const fs::path solve_ = work_ / "linen";
};

// The pixels of all channels of a picture.
std::vector<float> pixels_of(const fs::path& file) {
  const Result<LoadedImage> image = read_image(file);
  EXPECT_TRUE(image) << image.error().message();
  std::vector<float> all;
  if (!image) return all;
  for (int p = 0; p < image->planes.planes(); ++p) {
    const View<const float> plane = image->planes.plane(p);
    for (int y = 0; y < plane.height(); ++y)
      all.insert(all.end(), plane.row(y), plane.row(y) + plane.width());
  }
  return all;
}

TEST_F(SolvedPhotographs, StayPixelByPixelAsTheyAreOnTheirOwnGrid) {
  const Json facts = json_of("rectify linen");
  EXPECT_EQ(facts["mm_per_pixel"], 0.1);
  EXPECT_EQ(facts["size_known"], false);
  const fs::path rectified = facts["folder"].get<std::string>();
  EXPECT_EQ(rectified.parent_path(), solve_ / "rectified");
  for (const char* map : {"normal.exr", "albedo.exr", "sigma.exr", "status.png"})
    EXPECT_EQ(pixels_of(rectified / map), pixels_of(solve_ / map)) << map;
  const Result<ImageFileInfo> info = read_image_info(rectified / "normal.exr");
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_EQ(info->pitch_mm, PixelPitch()) << "a size that nobody knows";
}

// The camera that stands for none sees the photographs' own grid, half a turn of which is pixels again.
TEST_F(SolvedPhotographs, ByLightsThatWereTurnedRoundAreNotOutdated) {
  done("solve --photos photos -o turned --flip x -q");
  EXPECT_EQ(stored("turned/solve.json")["input"]["flip"], "x");
  EXPECT_EQ(json_of("status turned")["sessions"][0]["links"][1]["freshness"], "fresh");
}

TEST_F(SolvedPhotographs, AreTurnedByWholePixels) {
  const fs::path turned = json_of("rectify linen --turn 180")["folder"].get<std::string>();
  const Result<LoadedImage> was = read_image(solve_ / "albedo.exr"), is = read_image(turned / "albedo.exr");
  ASSERT_TRUE(was && is);
  ASSERT_EQ(is->info.size, (Size{65, 49}));
  for (const auto& [x, y] : {std::pair{10, 7}, {31, 24}, {50, 40}})
    EXPECT_NEAR(is->planes.plane(0)(64 - x, 48 - y), was->planes.plane(0)(x, y), 1e-3) << x << ", " << y;
}

TEST_F(SolvedPhotographs, GoOutByEveryPresetWhichSayThatTheirSizeIsNotKnown) {
  std::string presets;
  const Json listed = json_of("export --list");
  for (const Json& preset : listed["presets"])
    presets += (presets.empty() ? "" : ",") + preset["name"].get<std::string>();
  const Outcome outcome = run("export linen --preset " + presets + " --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("make its maps"));
  const Json exports = outcome.json()["exports"];
  ASSERT_EQ(exports.size(), listed["presets"].size());
  for (const Json& each : exports) {
    const std::string preset = each["preset"];
    EXPECT_EQ(each["folder"], (solve_ / "export" / preset).string());
    EXPECT_EQ(each["size_known"], false) << preset;
    EXPECT_EQ(each["mm_per_pixel"], 0.1) << preset;
    EXPECT_THAT(each["notes"].dump(), HasSubstr("0.1 mm a pixel is assumed")) << preset;
    EXPECT_EQ(each["from"]["raws"].size(), 6U) << preset;
    for (const Json& file : each["files"]) {
      const fs::path path = fs::path(each["folder"].get<std::string>()) / file["file"].get<std::string>();
      if (!fs::exists(path)) continue;
      const Result<ImageFileInfo> info = read_image_info(path);
      EXPECT_TRUE(!info || info->pitch_mm == PixelPitch()) << path;
    }
  }
  EXPECT_THAT(text(solve_ / "export/glb/linen.glb"), HasSubstr("\"size_known\":false"));
  EXPECT_THAT(text(solve_ / "export/usd/linen.usda"), HasSubstr("bool size_known = false"));
  EXPECT_THAT(text(solve_ / "export/mtlx/linen.mtlx"), HasSubstr("the size is not known"));
  EXPECT_THAT(text(solve_ / "export/u3m/linen.u3m"), HasSubstr("\"size_known\": false"));
  for (const fs::directory_entry& set : fs::directory_iterator(solve_ / "maps")) {
    EXPECT_THAT(text(set.path() / "maps.json"), HasSubstr("\"size_known\": false"));
    EXPECT_THAT(text(set.path() / "report.html"), HasSubstr("size is not known: 0.1 mm a pixel is assumed"));
  }
}

TEST_F(SolvedPhotographs, KeepTheSizeThatAPersonSays) {
  done("export linen --preset glb -q");
  const Json said = json_of("export linen --preset glb,png16,u3m --mm-per-pixel 0.05");
  for (const Json& each : said["exports"]) {
    EXPECT_FALSE(each.contains("size_known")) << each["preset"];
    EXPECT_EQ(each["mm_per_pixel"], 0.05);
    EXPECT_NEAR(each["size_mm"][0].get<double>(), 3.25, 1e-9);
  }
  const auto info = read_image_info(solve_ / "export/png16/linen_albedo.png");
  ASSERT_TRUE(info) << info.error().message();
  EXPECT_NEAR(info->pitch_mm[0], 0.05, 1e-6);
  const Json later = json_of("maps linen --maps height");
  EXPECT_EQ(later["mm_per_pixel"], 0.05) << "what was said is kept";
  EXPECT_FALSE(later.contains("size_known"));
  EXPECT_EQ(json_of("finish linen --recipe flat --mm-per-pixel 0.04")["mm_per_pixel"], 0.04);
  EXPECT_THAT(json_of("status linen")["sessions"][0].dump(), Not(HasSubstr("0.05 mm")));
}

TEST_F(SolvedPhotographs, AreFinishedMadeIntoMaterialsAndLookedAtAsSessionsAre) {
  EXPECT_THAT(done("status linen").output,
              AllOf(HasSubstr("linen"), HasSubstr("complete"), HasSubstr("weft make")));
  EXPECT_EQ(json_of("maps linen --recipe flat")["size_known"], false);
  EXPECT_EQ(json_of("finish linen --recipe flat")["size_known"], false);
  EXPECT_THAT(done("rectify linen").output, HasSubstr("the size is not known"));

  const Json made = json_of("make linen --preset glb");
  EXPECT_TRUE(fs::exists(solve_ / "export/glb/linen.glb")) << made["steps"];
  EXPECT_EQ(json_of("make linen")["made"].size(), 0U) << "nothing is made twice";
  EXPECT_EQ(run("status linen --strict").exit_code, 0);

  done("material new linen.toml --scan linen");
  const Json built = json_of("material build linen.toml")["materials"][0];
  const Json document = Json::parse(bytes_of(fs::path(built["folder"].get<std::string>()) / "material.json"));
  EXPECT_EQ(document["size_known"], false);
  EXPECT_EQ(document["mm_per_pixel"], 0.1);
  EXPECT_EQ(json_of("export linen.toml --preset glb")["exports"][0]["size_known"], false);
}

TEST_F(SolvedPhotographs, ThatAreFinishedGetTheMapsThatAPresetNeeds) {
  const Json finished = json_of("finish linen --recipe flat");
  const Outcome outcome = run("export linen --preset glb --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_THAT(outcome.error,
              AllOf(HasSubstr("finished as the newest are"), HasSubstr("without occlusion, roughness")));
  const std::string maps = outcome.json()["exports"][0]["from"]["maps"];
  EXPECT_NE(maps, finished["id"]);
  EXPECT_EQ(stored("linen/maps/" + maps + "/maps.json")["steps"][0]["do"], "flatten");
  EXPECT_EQ(run("export linen --preset unreal").error.find("make its maps"), std::string::npos);
}

TEST_F(SolvedPhotographs, AreNotToldToCalibrateWhatTheyHaveNot) {
  const Json maps = json_of("maps linen --maps height");
  EXPECT_THAT(maps["verdicts"].dump(), Not(AnyOf(HasSubstr("weft calibrate"), HasSubstr("calibration"))));
}

// Without a whole frame the cosine transform has no heights to compare with.
TEST_F(SolvedPhotographs, OfAMaskHaveAPriceAndMapsToo) {
  Image<float> mask(Size{65, 49});
  for (int y = 0; y < 49; ++y) {
    for (int x = 0; x < 65; ++x) mask(x, y) = std::hypot(x - 32, y - 24) < 20 ? 1.0F : 0.0F;
  }
  const std::vector<View<const float>> planes = {mask.plane()};
  ASSERT_TRUE(write_image(work_ / "photos" / "mask.png", planes, {"Y"}, {.type = SampleType::kUint8}));
  done("solve --photos photos -o masked -q");
  const Json rows = json_of("maps masked --explain")["rows"];
  EXPECT_EQ(rows[0]["setting"], "multigrid") << rows;
  EXPECT_EQ(rows[0]["error"], 0.0);
  EXPECT_EQ(json_of("export masked --preset glb,unreal")["exports"].size(), 2U);
}

TEST_F(SolvedPhotographs, RefuseWhatNeedsARig) {
  expect_refusal(work_, {"rectify", solve_.string(), "--calibration", "c", "-q"}, 64,
                 {"no camera to calibrate", "leave it out"});
  expect_refusal(work_, {"make", solve_.string(), "--to", "0.1", "-q"}, 64, {"weft solve --photos"});
  ASSERT_EQ(run("solve --photos photos -o draft --quality preview -q").exit_code, 0);
  expect_refusal(work_, {"export", (work_ / "draft").string(), "--preset", "glb", "-q"}, 66,
                 {"weft solve --photos"});
  ASSERT_EQ(run("solve --photos photos -q").exit_code, 0);
  for (const char* verb : {"export", "maps"})
    expect_refusal(
        work_, {verb, (work_ / "photos-solve").string(), "-q", verb[0] == 'e' ? "--preset=glb" : "--draft"},
        64, {"name one of these, as", "photos-solve/"});
  expect_refusal(work_, {"export", "photos", "--preset", "glb", "--mm-per-pixel", "1", "-q"}, 64,
                 {"a solve of photographs alone"}, {.folder = work_.path()});
}

TEST_F(SolvedPhotographs, WithAPixelOfNoSizeAreRefused) {
  const std::string document = bytes_of(solve_ / "solve.json");
  for (const char* pixel : {"-1", "0", "1e300", "\"wide\""}) {
    put_bytes(solve_ / "solve.json",
              "{ \"mm_per_pixel\": " + std::string(pixel) + "," + document.substr(document.find('{') + 1));
    expect_refusal(work_, {"rectify", solve_.string(), "-q"}, 65,
                   {"the size of a pixel is none", "solve.json", "mm_per_pixel is", "take it out"});
  }
}

}  // namespace
}  // namespace weft::test
