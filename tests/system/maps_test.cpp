// SPDX-License-Identifier: Apache-2.0
// Sets of maps of a small session, by the job and by the program.
#include "app/jobs/maps/maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "app/jobs/solve.h"
#include "core/image_io/image_io.h"
#include "core/session.h"
#include "tests/system/program.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using app::make_maps;
using app::MapsOptions;
using app::MapsReport;
using app::Recipe;
using testing::HasSubstr;

Recipe recipe_of(const std::string& steps) {
  Result<Recipe> recipe = app::recipe_from_json({{"steps", Json::parse(steps)}}, "here");
  EXPECT_TRUE(recipe) << recipe.error().message();
  return recipe ? std::move(*recipe) : Recipe();
}

std::vector<std::string> all_maps() {
  std::vector<std::string> names;
  for (const app::DerivedMap& map : app::derived_maps()) names.emplace_back(map.name);
  return names;
}

class Maps : public testing::Test {
 protected:
  void SetUp() override {
    simulate(scene_named("twill", {192, 128}), session_);
    app::SolveOptions options;
    options.method = "fast";
    options.previews = false;
    const auto report = app::solve_session({.folder = session_, .calibration = {}, .leds = {}}, options, {});
    ASSERT_TRUE(report) << report.error().message();
  }

  MapsOptions options(const std::string& steps = "[]") const {
    MapsOptions options;
    options.session = session_;
    options.recipe = recipe_of(steps);
    return options;
  }
  MapsReport made(const MapsOptions& options) const {
    const auto report = make_maps(options, {});
    EXPECT_TRUE(report) << report.error().message();
    return report ? *report : MapsReport();
  }

  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

TEST_F(Maps, AreTheSameBytesForAnyThreadsAndAreMadeOnce) {
  MapsOptions wanted = options(R"([{"do": "flatten", "always": true}, {"do": "crop", "width_mm": 4}])");
  wanted.maps = all_maps();
  MapsOptions aside = wanted;
  aside.output = work_ / "one";
  ASSERT_TRUE(make_maps(aside, {.threads = 1}));
  aside.output = work_ / "three";
  ASSERT_TRUE(make_maps(aside, {.threads = 3}));
  EXPECT_EQ(contents_of(work_ / "one"), contents_of(work_ / "three"));
  const MapsReport first = made(wanted), second = made(wanted);
  EXPECT_FALSE(first.was_there);
  EXPECT_TRUE(second.was_there);
  EXPECT_EQ(first.folder.parent_path(), session_ / "maps");
  EXPECT_EQ(contents_of(first.folder), contents_of(work_ / "one"));
}

TEST_F(Maps, OfTheirOwnDocumentAsARecipeAreThemselves) {
  const MapsOptions wanted =
      options(R"([{"do": "crop", "left_mm": 1, "width_mm": 4}, {"do": "color", "exposure": 0.5}])");
  const MapsReport first = made(wanted);
  const Result<Recipe> again = app::read_recipe(first.folder / "maps.json");
  ASSERT_TRUE(again) << again.error().message();
  MapsOptions repeated = wanted;
  repeated.recipe = *again;
  const MapsReport second = made(repeated);
  EXPECT_TRUE(second.was_there);
  EXPECT_EQ(second.folder, first.folder);
}

TEST_F(Maps, SayWhatTheyAreAndAreFinite) {
  MapsOptions wanted = options();
  wanted.maps = all_maps();
  const MapsReport report = made(wanted);
  const Json& d = report.document;
  EXPECT_EQ(d["schema"], "weft.maps/1");
  int files = 0;
  for (const Json& map : d["maps"]) {
    SCOPED_TRACE(map.dump());
    EXPECT_THAT(map["source"].get<std::string>(), testing::AnyOf("measured", "derived", "assumed"));
    if (!map.contains("file") || map["name"] == "mips") continue;
    const Result<LoadedImage> image = read_image(report.folder / map["file"].get<std::string>());
    ASSERT_TRUE(image) << image.error().message();
    ++files;
    EXPECT_EQ(image->info.size.width, d["width"].get<int>());
    for (int p = 0; p < image->planes.planes(); ++p) {
      for (int y = 0; y < image->planes.height(); ++y) {
        for (int x = 0; x < image->planes.width(); ++x) ASSERT_TRUE(std::isfinite(image->planes(x, y, p)));
      }
    }
  }
  EXPECT_GE(files, 6);
  EXPECT_TRUE(fs::exists(report.folder / "report.html"));
}

TEST_F(Maps, ColourIsMultipliedAndHeightFollowsTheScale) {
  const MapsReport plain = made([&] {
    MapsOptions o = options();
    o.maps = {"height"};
    return o;
  }());
  const double mm = plain.document["mm_per_pixel"].get<double>();
  MapsOptions changed = options(R"([{"do": "color", "exposure": -1}, {"do": "scale", "mm_per_pixel": )" +
                                std::to_string(2 * mm) + "}]");
  changed.maps = {"height"};
  const MapsReport other = made(changed);
  const auto range = [](const MapsReport& report) {
    const Json& height = report.document["maps"][0];
    return height["most"].get<double>() - height["least"].get<double>();
  };
  EXPECT_NEAR(range(other) / range(plain), 2, 1e-4);
  const auto before = read_image(plain.folder / "albedo.exr"),
             after = read_image(other.folder / "albedo.exr");
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->planes(60, 60, 1), before->planes(60, 60, 1) / 2, 1e-4F);
}

TEST_F(Maps, OfAPreviewTakeThePlaceOfTheOneBefore) {
  MapsOptions preview = options();
  preview.is_preview = true;
  const MapsReport first = made(preview);
  const MapsReport whole = made(options());
  EXPECT_NEAR(first.document["mm_per_pixel"].get<double>() / whole.document["mm_per_pixel"].get<double>(), 4,
              1e-9);
  preview.recipe = recipe_of(R"([{"do": "color", "exposure": 1}])");
  const MapsReport second = made(preview);
  EXPECT_FALSE(fs::exists(first.folder));
  EXPECT_TRUE(fs::exists(second.folder));
  EXPECT_TRUE(fs::exists(whole.folder));
}

TEST_F(Maps, AreRefusedInWordsAndLeaveNothingBehind) {
  ASSERT_TRUE(make_maps(options(), {}));  // rectified maps are there
  const auto expect_refused = [&](const MapsOptions& refused, ErrorKind kind, const std::string& words) {
    const auto before = contents_of(work_.path());
    const auto report = make_maps(refused, {});
    ASSERT_FALSE(report) << words;
    EXPECT_EQ(report.error().kind, kind) << report.error().message();
    EXPECT_THAT(report.error().message(), HasSubstr(words));
    EXPECT_EQ(contents_of(work_.path()), before);
  };
  expect_refused(options(R"([{"do": "crop", "left_mm": 1000}])"), ErrorKind::kUsage, "step 1 (crop)");
  expect_refused(options(R"([{"do": "repair", "spots": [{"x_mm": -9, "y_mm": 0, "radius_mm": 1}]}])"),
                 ErrorKind::kUsage, "step 1 (repair)");
  MapsOptions no_table = options();
  no_table.bare = work_ / "nothing.weft";
  expect_refused(no_table, ErrorKind::kNoInput, "nothing.weft");
  no_table.bare = session_;
  expect_refused(no_table, ErrorKind::kBadData, "no photograph by the light below");
}

// The photograph of a LED, or the dark one, stands for what the light below shows.
TEST_F(Maps, OfAnOpenTableAreAllHoleAndOfClothThatHidesAllWithoutOne) {
  const auto add_below = [](const fs::path& folder, bool is_dark) {
    Result<Session> session = read_session(folder);
    ASSERT_TRUE(session) << session.error().message();
    Shot below = is_dark ? *session->dark() : *session->lit().front();
    below.index = static_cast<int>(session->shots.size());
    below.led = 0;
    below.role = ShotRole::kBelow;
    session->shots.push_back(below);
    const Result<void> written = write_session(*session);
    ASSERT_TRUE(written) << written.error().message();
  };
  const fs::path bare = work_ / "bare.weft";
  fs::copy(session_, bare, fs::copy_options::recursive);
  add_below(bare, false);
  const auto opacity_with = [&](bool is_dark) {
    const std::string name = is_dark ? "closed.weft" : "open.weft";
    const fs::path cloth = work_ / name;
    fs::copy(session_, cloth, fs::copy_options::recursive);
    add_below(cloth, is_dark);
    MapsOptions wanted = options();
    wanted.session = cloth;
    wanted.bare = bare;
    wanted.maps = {"opacity"};
    const MapsReport report = made(wanted);
    return report.document["maps"][0];
  };
  const Json open = opacity_with(false), closed = opacity_with(true);
  EXPECT_EQ(open["way"], "bare-table") << open.dump();
  EXPECT_NEAR(open["mean"].get<double>(), 0, 1e-3);
  EXPECT_EQ(closed["way"], "opaque") << closed.dump();
  EXPECT_NEAR(closed["mean"].get<double>(), 1, 1e-3);
  const MapsReport unknown = made([&] {
    MapsOptions o = options();
    o.session = work_ / "open.weft";
    return o;
  }());
  EXPECT_THAT(unknown.document["verdicts"].dump(), HasSubstr("OPACITY_UNKNOWN"));
}

TEST_F(Maps, ByTheProgramAreTold) {
  const Outcome outcome =
      run_weft({"maps", session_.string(), "--maps", "height,roughness", "--cloth", "satin", "-q"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_THAT(outcome.output, testing::AllOf(HasSubstr("height:"), HasSubstr("typed for satin")));
  expect_refusal(work_, {"maps", session_.string(), "--recipe", "tiel"}, 66, {"tile"});
  expect_refusal(work_, {"finish", session_.string(), "--steps", "{"}, 64, {"--steps"});
  expect_refusal(work_, {"finish", session_.string(), "--steps", R"({"steps": [{"do": "tlie"}]})"}, 65,
                 {"tile"});
}

}  // namespace
}  // namespace weft::test
