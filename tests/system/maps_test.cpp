// SPDX-License-Identifier: Apache-2.0
// Sets of maps of a small session, by the job and by the program.
#include "material/run/maps.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/session.h"
#include "library/catalogue/metadata.h"
#include "material/run/session_sets.h"
#include "material/run/surface_files.h"
#include "solve/files/gloss_maps.h"
#include "solve/run/solve_session.h"
#include "tests/material/weave.h"
#include "tests/system/program.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using material::make_maps;
using material::MapsOptions;
using material::MapsReport;
using material::Recipe;
using testing::HasSubstr;

Recipe recipe_of(const std::string& steps) {
  Result<Recipe> recipe = material::recipe_from_json({{"steps", Json::parse(steps)}}, "here");
  EXPECT_TRUE(recipe) << recipe.error().message();
  return recipe ? std::move(*recipe) : Recipe();
}

std::vector<std::string> all_maps() {
  std::vector<std::string> names;
  for (const material::DerivedMap& map : material::derived_maps()) names.emplace_back(map.name);
  return names;
}

void scan_and_solve(const std::string& name, Size size, const fs::path& session) {
  simulator::Scene scene = scene_named(name, size);
  scene.effects.interreflection = false;  // it takes seconds, and changes no repeat
  simulate(scene, session);
  solve::SolveOptions options;
  options.method = "fast";
  options.previews = false;
  const auto report = solve::solve_session({.folder = session, .calibration = {}, .leds = {}}, options, {});
  ASSERT_TRUE(report) << report.error().message();
}

class Maps : public testing::Test {
 protected:
  void SetUp() override { scan_and_solve("twill", {192, 128}, session_); }

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
  const Result<Recipe> again = material::read_recipe(first.folder / "maps.json");
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
  const Json d = json_of(report.facts);
  EXPECT_EQ(d["schema"], "weft.maps/1");
  int files = 0;
  for (const Json& map : d["maps"]) {
    SCOPED_TRACE(map.dump());
    EXPECT_THAT(map["source"].get<std::string>(), testing::AnyOf("measured", "derived", "assumed"));
    if (!map.contains("file") || map["name"] == "mips") continue;  // of other sizes
    const Result<LoadedImage> image = read_image(report.folder / map["file"].get<std::string>());
    ASSERT_TRUE(image) << image.error().message();
    ++files;
    const Json& sized = map["name"] == "specular_occlusion" ? map : d;
    EXPECT_EQ(image->info.size.width, sized["width"].get<int>());
    EXPECT_EQ(image->info.size.height, sized["height"].get<int>());
    EXPECT_EQ(image->info.attributes.at("weft.source"), map["source"]);
    EXPECT_NEAR(std::stod(image->info.attributes.at("weft.mm_per_pixel")), d["mm_per_pixel"].get<double>(),
                1e-6);
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
  const double mm = plain.facts.mm_per_pixel;
  MapsOptions changed = options(R"([{"do": "color", "exposure": -1}, {"do": "scale", "mm_per_pixel": )" +
                                std::to_string(2 * mm) + "}]");
  changed.maps = {"height"};
  const MapsReport other = made(changed);
  const auto range = [](const MapsReport& report) {
    const material::MapFacts& height = report.facts.maps.at(0);
    return height.most - height.least;
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
  EXPECT_EQ(first.facts.size, whole.facts.size);
  EXPECT_EQ(first.facts.mm_per_pixel, whole.facts.mm_per_pixel);
  preview.recipe = recipe_of(R"([{"do": "color", "exposure": 1}])");
  const MapsReport second = made(preview);
  EXPECT_FALSE(fs::exists(first.folder));
  EXPECT_TRUE(fs::exists(second.folder));
  EXPECT_TRUE(fs::exists(whole.folder));
}

// A preview that refuses what the full run does is worse than none, and one that does not is a promise.
TEST_F(Maps, OfAPreviewComeOutAsThoseOfTheFullRun) {
  scan_and_solve("knit", {192, 128}, work_ / "knit.weft");
  scan_and_solve("twill", {96, 64}, work_ / "small.weft");
  for (const fs::path& session : {session_, work_ / "knit.weft", work_ / "small.weft"}) {
    SCOPED_TRACE(session.stem().string());
    MapsOptions wanted = options();
    wanted.session = session;
    wanted.recipe = material::recipe_named("tile");
    const auto full = make_maps(wanted, {});
    wanted.is_preview = true;
    const auto preview = make_maps(wanted, {});
    ASSERT_EQ(preview.has_value(), full.has_value());
    if (!full) {
      EXPECT_EQ(preview.error().message(), full.error().message());
      continue;
    }
    Json a = json_of(full->facts), b = json_of(preview->facts);
    for (Json* each : {&a, &b}) each->erase("id"), each->erase("preview");
    EXPECT_EQ(a, b);
  }
}

TEST_F(Maps, AssumeTheGlossOfTheSessionsKindOfClothAndSayWhoseItIs) {
  MapsOptions wanted = options();
  wanted.maps = {"roughness"};
  const auto roughness = [&] { return json_of(made(wanted).facts)["maps"][0]; };
  const Json unknown = roughness();
  EXPECT_EQ(unknown["source"], "assumed");
  EXPECT_THAT(unknown["why"].get<std::string>(), HasSubstr("nobody said what kind of cloth"));
  const auto stale = [&] {
    const std::vector<material::SessionSet> sets =
        material::sets_of(solve::solves_of(*read_session(session_)));
    return testing::PrintToString(sets.back().stale);
  };
  EXPECT_EQ(stale(), "{}");
  ASSERT_TRUE(library::change_metadata(session_, {{"kind", "satin"}}));
  EXPECT_THAT(stale(), HasSubstr("the cloth is satin, which nobody had said"));
  const Json satin = roughness();
  EXPECT_THAT(satin["why"].get<std::string>(), HasSubstr("by its kind, satin"));
  EXPECT_LT(satin["constant"].get<double>(), 0.6);
  wanted.derive.cloth = "cotton";
  EXPECT_EQ(roughness()["constant"], unknown["constant"]);
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
  MapsOptions table = options();
  table.table_albedo = {0.1, 0.1, 0.1};
  expect_refused(table, ErrorKind::kUsage, "--bare");
  table.bare = session_;
  table.table_albedo = {0.1, 1.1, 0.1};
  expect_refused(table, ErrorKind::kUsage, "0.1,1.1,0.1");
}

// The photograph of a LED, or the dark one, stands for what the light below shows.
class MapsOverALight : public Maps {
 protected:
  void SetUp() override {
    Maps::SetUp();
    photographed_below(bare_, 0);
  }

  // A copy of the session that has the photograph by this LED, from 0, or the dark one for the light below.
  static constexpr int kDark = -1;
  void photographed_below(const fs::path& folder, int led) const {
    fs::copy(session_, folder, fs::copy_options::recursive);
    Result<Session> session = read_session(folder);
    ASSERT_TRUE(session) << session.error().message();
    Shot below = led == kDark ? *session->dark() : *session->lit().at(static_cast<std::size_t>(led));
    below.index = static_cast<int>(session->shots.size());
    below.led = 0;
    below.role = ShotRole::kBelow;
    session->shots.push_back(below);
    const Result<void> written = write_session(*session);
    ASSERT_TRUE(written) << written.error().message();
  }
  MapsOptions options_by(int led) const {
    MapsOptions wanted = options();
    wanted.session = work_ / fmt::format("by{}.weft", led);
    if (!fs::exists(wanted.session)) photographed_below(wanted.session, led);
    wanted.bare = bare_;
    wanted.maps = {"opacity"};
    return wanted;
  }

  const fs::path bare_ = work_ / "bare.weft";
};

TEST_F(MapsOverALight, OfAnOpenTableAreAllHoleAndOfClothThatHidesAllWithoutOne) {
  const Json open = made(options_by(0)).facts.maps.at(0).document;
  const Json closed = made(options_by(kDark)).facts.maps.at(0).document;
  EXPECT_EQ(open["way"], "bare-table") << open.dump();
  EXPECT_NEAR(open["mean"].get<double>(), 0, 1e-3);
  EXPECT_EQ(closed["way"], "opaque") << closed.dump();
  EXPECT_NEAR(closed["mean"].get<double>(), 1, 1e-3);
  MapsOptions unknown = options_by(0);
  unknown.bare.clear();
  EXPECT_THAT(json_of(made(unknown).facts.verdicts).dump(), HasSubstr("OPACITY_UNKNOWN"));
}

TEST_F(MapsOverALight, HaveMipsThatCutAsMuchAsTheFinest) {
  const MapsReport report = made(options_by(1));
  const Json& map = report.facts.maps.at(0).document;
  const Json& levels = map["levels"];
  ASSERT_GT(levels.size(), 3U) << map.dump();
  for (const Json& level : levels) {
    const auto file = fmt::format("mips/opacity_{:02}.exr", level["level"].get<int>());
    EXPECT_TRUE(fs::exists(report.folder / file)) << file;
  }
}

TEST_F(MapsOverALight, AreOfClothAloneWhereTheTableIsTakenOut) {
  MapsOptions wanted = options_by(6);
  const MapsReport seen = made(wanted);
  wanted.table_albedo = {0.05, 0.05, 0.05};
  const MapsReport cloth = made(wanted);
  ASSERT_NE(cloth.folder, seen.folder);
  ASSERT_TRUE(cloth.facts.table);
  ASSERT_GT(cloth.facts.table->unmixed, 0);
  const auto opacity = read_image(seen.folder / "opacity.exr"), with = read_image(seen.folder / "albedo.exr"),
             without = read_image(cloth.folder / "albedo.exr");
  ASSERT_TRUE(opacity && with && without);
  int compared = 0;
  for (int y = 0; y < opacity->planes.height(); ++y) {
    for (int x = 0; x < opacity->planes.width(); ++x) {
      const float share = opacity->planes(x, y);
      if (share < 0.4F || share > 0.9F) continue;
      // A dark table under a share of the pixel made it darker than its cloth.
      EXPECT_GT(without->planes(x, y, 1), with->planes(x, y, 1)) << x << ", " << y << ": " << share;
      ++compared;
    }
  }
  EXPECT_GT(compared, 0);
}

// An albedo without a scale has no f0; what the solve says of roughness stands.
TEST(SurfaceFiles, OfARelativeAlbedoKeepTheirRoughness) {
  const Workspace work;
  const Size size = {5, 4};
  material::RectifiedSurface kept;
  material::Surface& surface = kept.surface;
  surface.mm_per_pixel = 0.1;
  surface.slope = Image<float>(size, 2);
  surface.albedo = Image<float>(size, 3);
  surface.sigma_deg = Image<float>(size);
  surface.status = Image<std::uint16_t>(size);
  surface.lobe = Image<float>(size, 4);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      surface.lobe(x, y, 0) = 0.25F;
      surface.lobe(x, y, 1) = 0.5F;
      surface.lobe(x, y, 3) = 0.07F;
    }
  }
  for (const bool has_f0 : {true, false}) {
    const fs::path folder = work / (has_f0 ? "absolute" : "relative");
    fs::create_directory(folder);
    kept.has_f0 = has_f0;
    const Result<void> written = material::write_surface(folder, kept, Compression::kNone);
    ASSERT_TRUE(written) << written.error().message();
    const Image<float> sigma(size, 4);  // rectified maps keep that of each channel
    ASSERT_TRUE(
        write_image(folder / "sigma.exr", material::planes_of(sigma), {"R", "G", "B", "normal_deg"}, {}));
    const auto read = material::read_surface(folder, 0.1);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->has_f0, has_f0);
    EXPECT_NEAR(read->surface.lobe(2, 2, 0), 0.25, 1e-3);
    EXPECT_NEAR(read->surface.lobe(2, 2, 1), 0.5, 1e-3);
    EXPECT_NEAR(read->surface.lobe(2, 2, 3), has_f0 ? 0.07 : solve::kTypedF0, 1e-4);
  }
}

// A plain weave that lies turned on the table.
simulator::Scene turned_weave(double turn_deg) {
  simulator::Scene scene = scene_named("flat", {288, 216});
  const material::WeaveSettings settings = {
      .pitch_x_px = 11, .pitch_y_px = 10, .turn_deg = turn_deg, .tone = 0};
  const material::Weave weave(settings);
  Image<float> heights({360, 288});
  for (int y = 0; y < heights.height(); ++y) {
    for (int x = 0; x < heights.width(); ++x) {
      const material::Vec2 at = {x - 179.5, 143.5 - y};
      heights(x, y) = static_cast<float>(scene.camera.mm_per_pixel * weave.seen(at, heights.size()).z);
    }
  }
  scene.geometry = {};
  scene.geometry.kind = simulator::GeometryKind::kHeightMap;
  scene.geometry.height_map.mm_per_sample = scene.camera.mm_per_pixel;
  scene.geometry.heights_mm = std::make_shared<const Image<float>>(std::move(heights));
  return scene;
}

TEST_F(Maps, OfAClothThatLiesTurnedAreStraightenedOnceTheirRemedyIsFollowed) {
  const fs::path turned = work_ / "turned.weft";
  simulate(turned_weave(25), turned);
  ASSERT_EQ(run_weft({"solve", turned.string(), "--quality", "fast", "-q"}).exit_code, 0);
  const auto finished = [&](const std::string& recipe) {
    const Outcome outcome =
        run_weft({"finish", turned.string(), "--recipe", recipe, "--strict", "--json", "-q"});
    Json made = Json::parse(outcome.output, nullptr, false);
    EXPECT_EQ(outcome.exit_code, made["verdicts"].empty() ? 0 : 2) << outcome.error << outcome.output;
    return made;
  };
  const Json asked = finished("tile");
  const Json& found = asked["steps"][1]["facts"];
  EXPECT_EQ(found["acts"], false);
  EXPECT_NEAR(std::abs(found["turn_deg"].get<double>()), 25, 0.1) << found;
  EXPECT_NEAR(found["yarn_px"][0].get<double>(), 11, 0.05) << found;
  EXPECT_NEAR(found["yarn_px"][1].get<double>(), 10, 0.05) << found;
  ASSERT_EQ(asked["verdicts"][0]["name"], "TURN_ASKED");
  const fs::path maps = turned / "maps" / asked["id"].get<std::string>();
  EXPECT_TRUE(fs::is_regular_file(maps / found["picture"].get<std::string>()));
  EXPECT_THAT(read_text(maps / "report.html").value(), HasSubstr("where the yarns seem to lie"));

  const std::string remedy = asked["verdicts"][0]["remedy"].get<std::string>();
  const std::size_t begin = remedy.find("straighten = {"), end = remedy.find('}');
  ASSERT_LT(begin, end) << remedy;
  const std::string keys = remedy.substr(begin, end + 1 - begin);
  ASSERT_TRUE(write_file(work_ / "said.toml", "recipe = \"tile\"\n" + keys + "\n"));
  const Json said = finished((work_ / "said.toml").string());
  EXPECT_EQ(said["steps"][1]["facts"]["acts"], true) << said["verdicts"];
  EXPECT_EQ(said["steps"][2]["facts"]["has_repeat"], true);
  for (const Json& verdict : said["verdicts"]) EXPECT_NE(verdict["name"], "TURN_ASKED") << verdict;
}

TEST_F(Maps, ByTheProgramAreTold) {
  const Outcome outcome =
      run_weft({"maps", session_.string(), "--maps", "height,roughness", "--cloth", "satin", "-q"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_THAT(outcome.output, testing::AllOf(HasSubstr("height:"), HasSubstr("by its kind, satin")));
  expect_refusal(work_, {"maps", session_.string(), "--recipe", "tiel"}, 66, {"tile"});
  expect_refusal(work_, {"finish", session_.string(), "--steps", "{"}, 64, {"--steps"});
  expect_refusal(work_, {"finish", session_.string(), "--steps", R"({"steps": [{"do": "tlie"}]})"}, 65,
                 {"tile"});
}

TEST_F(Maps, ArePricedWhereNoCoarserGridHoldsATile) {
  ASSERT_EQ(run_weft({"finish", session_.string(), "--recipe", "tile", "-q"}).exit_code, 0);
  const Outcome explained =
      run_weft({"finish", session_.string(), "--recipe", "tile", "--explain", "--json", "-q"});
  ASSERT_EQ(explained.exit_code, 0) << explained.error;
  const Json rows = explained.json()["rows"];
  ASSERT_EQ(rows.size(), 1U) << rows.dump() << ": 96 x 64 pixels hold no tile";
  EXPECT_TRUE(rows[0]["chosen"]);
  EXPECT_EQ(rows[0]["steps"].size(), 5U) << "rectify, three steps, write";
}

TEST_F(Maps, AreFinishedOnTheGridThatIsWorthItsSeconds) {
  const auto explained = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"finish", session_.string(), "--recipe", "flat", "--explain", "--json", "-q"});
    return run_weft(more).json()["rows"];
  };
  const Json rows = explained({});
  ASSERT_EQ(rows.size(), 3u);
  double lost = 1e9, mm = 1e9;
  for (const Json& row : rows) {
    double seconds = 0;
    for (const Json& step : row["steps"]) seconds += step["seconds"].get<double>();
    EXPECT_NEAR(row["seconds"].get<double>(), seconds, 1e-9);
    EXPECT_EQ(row["steps"].front()["step"], "rectify");
    EXPECT_EQ(row["steps"].back()["step"], "write");
    EXPECT_LT(row["lost_deg"].get<double>(), lost);
    EXPECT_LT(row["mm_per_pixel"].get<double>(), mm);
    lost = row["lost_deg"], mm = row["mm_per_pixel"];
  }
  EXPECT_EQ(lost, 0) << "the finest loses nothing";
  EXPECT_TRUE(rows[2]["chosen"]);
  EXPECT_FALSE(is_there(session_ / "maps")) << "only told";
  EXPECT_EQ(std::distance(fs::directory_iterator(session_ / "rectified"), {}), 1) << "the finest stays";
  const double enough = rows[1]["lost_deg"].get<double>() * 1.001;
  EXPECT_TRUE(explained({"--to", fmt::format("{}", enough)})[1]["chosen"]);
  expect_refusal(work_,
                 {"finish", session_.string(), "--recipe", "flat", "--explain", "--within", "1e-6", "-q"}, 64,
                 {"no grid is that quick", "the coarsest, of"});
  const Json made = run_weft({"finish", session_.string(), "--recipe", "flat", "--to",
                              fmt::format("{}", enough), "--json", "-q"})
                        .json();
  EXPECT_NEAR(made["mm_per_pixel"].get<double>(), rows[1]["mm_per_pixel"].get<double>(), 1e-9);
}

}  // namespace
}  // namespace weft::test
