// SPDX-License-Identifier: Apache-2.0
// Sets of maps over HTTP, seen by the code that shows solves.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/server/rig_server.h"
#include "bench/server/served_rig.h"
#include "core/base/files.h"
#include "material/run/maps.h"
#include "tests/app/server/raw_client.h"
#include "tests/app/server/view/asked_session.h"

namespace weft::app {
namespace {

using testing::HasSubstr;

class MapSets : public AskedSession {
 protected:
  static void SetUpTestSuite() {
    AskedSession::SetUpTestSuite();
    material::MapsOptions options;
    options.session = session();
    options.mm_per_pixel = kGrid_mm;
    options.maps = {"height", "occlusion"};
    const Result<material::MapsReport> made = material::make_maps(options, {});
    ASSERT_TRUE(made) << made.error().message();
    set_ = json_of(made->facts);
    set_folder_ = made->folder;
  }
  void SetUp() override {
    auto server = bench::server_without_devices("maps", root() / "scans", root() / "state");
    ASSERT_TRUE(server) << server.error().message();
    server_ = std::move(*server);
  }
  Answer get(const std::string& path) const { return ask(server_->port(), "GET", "/api/v1/" + path); }
  static std::string id() { return set_["id"].get<std::string>(); }
  static std::string here() { return "sessions/asked/maps/" + id(); }

  static constexpr double kGrid_mm = 0.1;
  static inline Json set_;
  static inline std::filesystem::path set_folder_;
  std::unique_ptr<RigServer> server_;
};

TEST_F(MapSets, AreListedWithTheSolveThatTheyWereMadeOf) {
  const Json sets = get("sessions/asked/maps").json()["sets"];
  ASSERT_EQ(sets.size(), 1U);
  EXPECT_EQ(sets[0]["id"], id());
  EXPECT_EQ(sets[0]["solve"], solve_.id);
  EXPECT_EQ(sets[0]["maps"], Json::array({"height", "occlusion", "bent_normal", "specular_occlusion"}));
  EXPECT_EQ(sets[0]["preview"], false);
  EXPECT_EQ(sets[0]["mm_per_pixel"], kGrid_mm);
  EXPECT_GT(sets[0]["bytes"].get<int>(), 10000);
  EXPECT_EQ(get("sessions/none/maps").status, 404);
}

TEST_F(MapSets, AreSeenAsASolveIs) {
  const Json one = get(here()).json();
  EXPECT_EQ(one["width"], set_["width"]);
  EXPECT_EQ(one["method"], solve_.method);
  EXPECT_NEAR(one["mm_per_pixel"].get<double>(), kGrid_mm, 1e-12);
  EXPECT_EQ(one["set"]["schema"], "weft.maps/1");
  const auto pixels = static_cast<std::size_t>(set_["width"].get<int>() * set_["height"].get<int>());
  for (const auto& [layer, bytes] : {std::pair<std::string, std::size_t>("normal", 4),
                                     {"albedo", 6},
                                     {"sigma", 2},
                                     {"height", 2},
                                     {"occlusion", 2},
                                     {"bent_normal", 4},
                                     {"status", 1}}) {
    const Answer raw = get(fmt::format("{}/tiles/{}/0/0_0.raw", here(), layer));
    ASSERT_EQ(raw.status, 200) << layer << raw.body;
    EXPECT_EQ(raw.body.size(), bytes * pixels) << layer;
    EXPECT_THAT(raw.head, HasSubstr("immutable")) << layer;
  }
  EXPECT_EQ(get(here() + "/tiles/relit/top/0_0.jpg").status, 200);
  EXPECT_EQ(get(here() + "/tiles/residual/0/0_0.raw").status, 404);
  for (const Json& layer : one["layers"]) {
    EXPECT_EQ(layer["kind"] == "normal", layer["name"] == "normal" || layer["name"] == "bent_normal")
        << layer;
  }
}

TEST_F(MapSets, AreSeenBesideTheRectifiedMapsThatTheyWereMadeOf) {
  const std::string rectified = "sessions/asked/maps/" + set_["rectified"].get<std::string>();
  const Json before = get(rectified).json(), after = get(here()).json();
  for (const char* same : {"width", "height", "mm_per_pixel", "method", "albedo_scale"})
    EXPECT_EQ(before[same], after[same]) << same;
  EXPECT_EQ(before["set"]["schema"], "weft.rectified/1");
  EXPECT_EQ(after["set"]["place"]["centre_px"],
            Json({0.5 * after["width"].get<int>(), 0.5 * after["height"].get<int>()}));
  const std::string pixel = "/pixel?x=10&y=20";
  EXPECT_EQ(get(rectified + pixel).json()["maps"]["albedo"], get(here() + pixel).json()["maps"]["albedo"])
      << "no step changed them";
  EXPECT_EQ(get(rectified + "/tiles/relit/top/0_0.jpg").status, 200);
  EXPECT_EQ(get(rectified + "/tiles/height/0/0_0.raw").status, 404);
}

TEST_F(MapSets, AreMeasuredInMillimetresOfTheirGrid) {
  const Json line = get(here() + "/line?x0=10&y0=20&x1=40&y1=60").json();
  EXPECT_NEAR(line["mm"].get<double>(), 50 * kGrid_mm, 1e-12);
  EXPECT_TRUE(line["sigma_mm"].is_null());
  const Json heights = line["profile"]["height_mm"], mm = line["profile"]["mm"];
  EXPECT_NEAR(mm[mm.size() - 1].get<double>(), 50 * kGrid_mm, 1e-12);
  const Json at_begin = get(here() + "/pixel?x=10&y=20").json(),
             at_end = get(here() + "/pixel?x=40&y=60").json();
  const double risen =
      at_end["maps"]["height"][0].get<double>() - at_begin["maps"]["height"][0].get<double>();
  EXPECT_NEAR(heights[heights.size() - 1].get<double>(), risen, 0.1)
      << "the slopes along the line rise as the height that was integrated over all of them";
  EXPECT_TRUE(at_begin["readings"].is_null());
  EXPECT_FALSE(at_begin.contains("table_mm"));
  const Json region = get(here() + "/region?x=0&y=0&w=8&h=4").json();
  EXPECT_EQ(region["pixels"], 32);
  EXPECT_TRUE(region["layers"]["height"].contains("height"));
}

TEST_F(MapSets, RefuseWhatIsNotThereAndWhatIsDamaged) {
  EXPECT_EQ(get("sessions/asked/maps/0000000000000000").json()["error"]["code"], "no_such_maps");
  EXPECT_EQ(get("sessions/asked/maps/truth").status, 404);
  EXPECT_EQ(get(here() + "/line?x0=0&y0=0&x1=1e9&y1=4").status, 400);
  const std::filesystem::path damaged = set_folder_.parent_path() / "0123456789abcdef";
  std::filesystem::copy(set_folder_, damaged);
  Json document = set_;
  document["id"] = "0123456789abcdef";
  document["solve"] = 7;
  document["verdicts"] = "none";
  document["maps"] = Json::array({7, {{"name", "far"}, {"file", "../far.exr"}, {"channels", {"Y"}}}});
  ASSERT_TRUE(write_json(damaged / "maps.json", document));
  EXPECT_EQ(get("sessions/asked/maps/0123456789abcdef").status, 422);
  EXPECT_EQ(get("sessions/asked/maps").json()["sets"].size(), 1U) << "a damaged one is passed over";
  document["solve"] = "gone";
  document["verdicts"] = Json::array();
  document["maps"] =
      Json::array({{{"name", "far"}, {"file", "../far.exr"}, {"channels", {"Y"}}, {"source", "derived"}}});
  ASSERT_TRUE(write_json(damaged / "maps.json", document));
  const Json seen = get("sessions/asked/maps/0123456789abcdef").json();
  EXPECT_EQ(seen["albedo_scale"], "relative") << "whose solve is gone";
  for (const Json& layer : seen["layers"]) EXPECT_NE(layer["name"], "far");
  std::filesystem::remove_all(damaged);
}

TEST_F(MapSets, ShowThePicturesThatLieBesideThem) {
  const Answer picture = get(here() + "/pictures/relit.png");
  EXPECT_EQ(picture.status, 200) << picture.body;
  EXPECT_EQ(picture.body.substr(1, 3), "PNG");
  for (const char* other : {"maps.json", "normal.exr", "none.png", "..%2frelit.png"})
    EXPECT_EQ(get(here() + "/pictures/" + other).status, 404) << other;
}

TEST_F(MapSets, HaveRecipesWhoseStepsAreKnown) {
  const Json recipes = get("recipes").json();
  EXPECT_EQ(recipes["recipes"].size(), 3U);
  const auto is_known = [&](const Json& step) {
    for (const Json& kind : recipes["steps"]) {
      if (kind["name"] != step["do"]) continue;
      for (const Json& key : kind["keys"]) EXPECT_EQ(step[key["name"].get<std::string>()], key["default"]);
      return true;
    }
    return false;
  };
  for (const Json& recipe : recipes["recipes"]) {
    EXPECT_FALSE(recipe["steps"].empty()) << recipe;
    for (const Json& step : recipe["steps"]) EXPECT_TRUE(is_known(step)) << step;
  }
}

}  // namespace
}  // namespace weft::app
