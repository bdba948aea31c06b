// SPDX-License-Identifier: Apache-2.0
// Photographs for a calibration, through the virtual camera, with what can be wrong with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>

#include "bench/server/served_rig.h"
#include "core/base/files.h"
#include "core/base/json_document.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kWork = "/api/v1/calibrations/work";

class CaptureAtTheRig : public testing::Test {
 protected:
  explicit CaptureAtTheRig(double megapixels = 0.25) : megapixels_(megapixels) {}
  void SetUp() override {
    ASSERT_TRUE(served_.start(program_folder(), in_sources("testdata/scenes/rig.toml"), megapixels_));
    ASSERT_TRUE(served_.serve());
  }

  Json begin(const std::string& part, const char* description) {
    Json body = {{"part", part}};
    if (description != nullptr) body["description"] = read_text(targets() / description).value();
    return answer(served_.client().post(kWork, body));
  }
  fs::path targets() const { return served_.rig().folder() / "targets"; }

  static Json answer(const Result<Json>& document) {
    EXPECT_TRUE(document) << document.error().message();
    return document ? *document : Json();
  }
  void lay(const std::string& thing) {
    const auto laid = served_.rig().say("table " + thing);
    ASSERT_TRUE(laid) << laid.error().message();
  }
  /// The set after the next photograph.
  Json photograph() {
    const Result<Json> begun = served_.client().post(std::string(kWork) + "/photograph", Json::object());
    if (!begun) return {{"error", begun.error().message()}};
    for (;; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
      Json set = answer(served_.client().get(kWork));
      if (set.is_null() || !set["busy"]) return set;
    }
  }
  static Json of(const Json& set, const std::string& name) {
    for (const Json& photograph : set["photographs"]) {
      if (photograph["name"].get<std::string>().starts_with(name)) return photograph;
    }
    return {{"why", "there is none"}};
  }

  ServedRig served_;

 private:
  const double megapixels_;
};

TEST_F(CaptureAtTheRig, SaysOfEachBoardWhetherItIsOfUseAndWhyNot) {
  begin("board", "board.toml");
  lay("board");
  Json set = photograph();
  EXPECT_TRUE(of(set, "table01")["used"]) << set;
  const double focal_percent = set["figures"]["predicted"]["focal_percent"];

  lay("board tilt=35 azimuth=90 columns=8 rows=5");
  EXPECT_THAT(of(photograph(), "board01")["why"].get<std::string>(), HasSubstr("squares"));
  lay("board tilt=20 x=90");
  EXPECT_THAT(of(photograph(), "board02")["why"].get<std::string>(), HasSubstr("partial"));
  lay("empty");
  EXPECT_THAT(of(photograph(), "board03")["why"].get<std::string>(), HasSubstr("no board"));
  lay("board tilt=35 azimuth=90");
  set = photograph();
  EXPECT_TRUE(of(set, "board04")["used"]) << of(set, "board04");
  EXPECT_LT(set["figures"]["predicted"]["focal_percent"].get<double>(), focal_percent);
  set = photograph();
  EXPECT_THAT(of(set, "board05").dump(), HasSubstr("much like one before"));
  lay("board mirrored=1");
  EXPECT_THAT(of(photograph(), "board06")["why"].get<std::string>(), HasSubstr("mirrored"));
}

TEST_F(CaptureAtTheRig, IsNotDoneHoweverManyBoardsLieFlat) {
  begin("board", "board.toml");
  Json set;
  for (const char* board : {"board", "board x=-35 y=21", "board x=35 y=21 turn=90", "board x=35 y=-21",
                            "board x=-35 y=-21", "board turn=45", "board turn=180"}) {
    lay(board);
    set = photograph();
    EXPECT_TRUE(set["photographs"].back()["used"]) << set["photographs"].back();
  }
  EXPECT_EQ(set["photographs"].size(), 7U);
  EXPECT_FALSE(set["done"]);
  EXPECT_GT(set["figures"]["predicted"]["focal_percent"].get<double>(),
            10 * set["figures"]["asked"]["focal_percent"].get<double>())
      << set["figures"]["predicted"];
  EXPECT_THAT(set["next"]["says"].get<std::string>(), HasSubstr("tilt"));
}

TEST_F(CaptureAtTheRig, TellsABoardThatIsTiltedOtherwiseThanAsked) {
  begin("board", "board.toml");
  lay("board tilt=20 azimuth=90");
  Json set = photograph();
  EXPECT_THAT(of(set, "table01")["facts"].value("note", ""), HasSubstr("tilted by 20 degrees")) << set;
  ASSERT_GT(set["next"]["pose"]["tilt_deg"].get<double>(), 13) << set["next"];
  const double asked_deg = set["next"]["pose"]["tilt_deg"];
  lay("board tilt=20 azimuth=90 x=30");
  set = photograph();
  EXPECT_NEAR(of(set, "board01")["facts"]["tilt_deg"].get<double>(), 0, 3) << "to the table that it shows";
  EXPECT_THAT(of(set, "board01")["facts"].value("note", ""),
              HasSubstr(std::to_string(std::lround(asked_deg)) + " degrees of tilt were asked"));
}

TEST_F(CaptureAtTheRig, GoesOnAfterTheDaemonWasKilled) {
  begin("board", "board.toml");
  lay("board");
  const Json before = photograph();
  served_.kill_daemon();
  ASSERT_TRUE(served_.serve());
  EXPECT_EQ(answer(served_.client().get(kWork)), Json()) << "nobody has taken the set up yet";
  const Json after = begin("board", nullptr);
  EXPECT_EQ(after["photographs"], before["photographs"]);
  EXPECT_EQ(after["figures"], before["figures"]);
  EXPECT_EQ(after["next"], before["next"]);
}

TEST_F(CaptureAtTheRig, LeavesAPhotographOutAndTakesItBack) {
  begin("board", "board.toml");
  lay("board");
  photograph();
  lay("board tilt=35 azimuth=90");
  const Json before = photograph();
  const std::string leave_out = std::string(kWork) + "/leave-out";
  const Json without = answer(served_.client().post(leave_out, {{"name", "board01.dng"}}));
  EXPECT_TRUE(of(without, "board01")["left_out"]);
  EXPECT_GT(without["figures"]["predicted"]["focal_percent"],
            before["figures"]["predicted"]["focal_percent"]);
  const Json back = answer(served_.client().post(leave_out, {{"name", "board01.dng"}, {"out", false}}));
  EXPECT_EQ(back["figures"], before["figures"]);
  const Result<Json> none = served_.client().post(leave_out, {{"name", "../rig.toml"}});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("no such photograph"));
}

TEST_F(CaptureAtTheRig, BeginsWithABoardWhereTheRigHasNoCalibration) {
  served_.kill_daemon();
  const fs::path file = served_.rig().folder() / "rig.toml";
  std::string toml = read_text(file).value();
  const std::string line = "calibration = \"calibration\"\n";
  ASSERT_NE(toml.find(line), std::string::npos);
  ASSERT_TRUE(write_file(file, toml.erase(toml.find(line), line.size())));
  ASSERT_TRUE(served_.serve());
  EXPECT_EQ(begin("board", "board.toml")["next"]["name"], "table01");
  lay("board");
  Json set = photograph();
  const double unknown_percent = set["figures"]["predicted"]["focal_percent"];
  for (const char* pose : {"board tilt=35 azimuth=0", "board tilt=35 azimuth=90 x=10"}) {
    lay(pose);
    set = photograph();
  }
  const double known_percent = set["figures"]["predicted"]["focal_percent"];
  EXPECT_GT(unknown_percent, 5) << "one flat board tells no focal length";
  EXPECT_LT(known_percent, 1) << set["figures"];
}

TEST_F(CaptureAtTheRig, RefusesWhatItCannotWorkOn) {
  const auto refusal = [&](const Json& body) {
    const Result<Json> begun = served_.client().post(kWork, body);
    return begun ? std::string("taken") : begun.error().message();
  };
  EXPECT_THAT(refusal({{"part", "stone"}}), HasSubstr("board, response"));
  std::filesystem::remove(targets() / "board.toml");  // else the rig knows it
  EXPECT_THAT(refusal({{"part", "board"}}), HasSubstr("nobody said what the board is"));
  EXPECT_THAT(refusal({{"part", "board"}, {"description", "squares_x = 9"}}), HasSubstr("squares_y"));
  EXPECT_THAT(refusal({{"part", "board"}, {"name", "../x"}, {"description", ""}}),
              HasSubstr("no name of a set"));
  EXPECT_THAT(refusal({{"part", "response"}, {"from", "/nowhere"}}), HasSubstr("nowhere"));
  const Result<Json> none = served_.client().post(std::string(kWork) + "/leave-out", {{"name", 1}});
  EXPECT_FALSE(none);
  begin("chart", "chart.toml");
  EXPECT_THAT(refusal({{"part", "board"}, {"name", "chart"}}), HasSubstr("it is a set of part chart"));
}

TEST_F(CaptureAtTheRig, ListsASeriesOnceAllItsPhotographsAreThere) {
  const auto complete = [&] {
    return answer(served_.client().get("/api/v1/calibrations"))["complete_series"];
  };
  begin("trap", nullptr);
  EXPECT_EQ(complete(), Json::array());
  lay("trap");
  EXPECT_TRUE(photograph()["done"]);
  EXPECT_EQ(complete(), Json::array({"trap"}));
  begin("board", "board.toml");
  EXPECT_EQ(complete(), Json::array({"trap"})) << "a set of boards is told by its figures";
}

TEST_F(CaptureAtTheRig, SaysOfAChartHowItLies) {
  begin("chart", "chart.toml");
  lay("empty");
  Json set = photograph();
  EXPECT_THAT(of(set, "chart.weft")["why"].get<std::string>(), HasSubstr("no chart")) << set;
  EXPECT_EQ(set["next"]["name"], "chart_2.weft");
  lay("chart turn=180");
  set = photograph();
  EXPECT_TRUE(of(set, "chart_2")["used"]) << set;
  EXPECT_THAT(of(set, "chart_2")["facts"].value("note", ""), HasSubstr("upside down")) << set;
  const Json outline = of(set, "chart_2")["facts"]["outline"];
  ASSERT_EQ(outline.size(), 4U) << set;
  double x = 0, y = 0;
  for (const Json& corner : outline) x += corner[0].get<double>() / 4, y += corner[1].get<double>() / 4;
  EXPECT_NEAR(x, 0.5, 0.05) << outline << " is not about the middle, where the chart lies";
  EXPECT_NEAR(y, 0.5, 0.05) << outline;
  EXPECT_GT(std::abs(outline[0][0].get<double>() - outline[2][0].get<double>()), 0.2) << outline;
  EXPECT_TRUE(set["done"]) << set;
  EXPECT_EQ(set["photographs"].size(), 2u) << "what was of no use is kept, left out";
}

TEST_F(CaptureAtTheRig, TellsASheetThatWearsAFold) {
  begin("sheet", "sheet.toml");
  lay("sheet fold=4");
  const Json folded = photograph();
  EXPECT_THAT(of(folded, "sheet01")["why"].get<std::string>(), HasSubstr("not smooth")) << folded;
  lay("sheet");
  const Json flat = photograph();
  EXPECT_TRUE(of(flat, "sheet01_2")["used"]) << flat;
}

TEST_F(CaptureAtTheRig, TellsALampOfTheRoomBySheetAndSet) {
  begin("sheet", "sheet.toml");
  lay("sheet");
  ASSERT_TRUE(served_.rig().say("light ambient 0.2"));
  const Json lit = photograph();
  const std::string said = lit["error"].is_null() ? of(lit, "sheet01")["why"].get<std::string>()
                                                  : lit["error"]["what"].get<std::string>();
  EXPECT_THAT(said, HasSubstr("lamp")) << lit;
  ASSERT_TRUE(served_.rig().say("light normal"));
  const Json dark = photograph();
  EXPECT_EQ(dark["error"], Json()) << dark;
  EXPECT_EQ(dark["next"]["name"].get<std::string>().substr(0, 7), "sheet02") << dark;
}

TEST_F(CaptureAtTheRig, TellsASheetThatLiesAsBefore) {
  begin("sheet", "sheet.toml");
  lay("sheet");
  const Json first = photograph();
  EXPECT_TRUE(of(first, "sheet01")["used"]) << first;
  EXPECT_THAT(first["next"]["says"].get<std::string>(), HasSubstr("left edge"));
  const Json again = photograph();
  EXPECT_THAT(of(again, "sheet02")["why"].get<std::string>(), HasSubstr("lies as it did in sheet01"));
  EXPECT_TRUE(of(again, "sheet02")["left_out"]) << "weft calibrate lights reads the folder as it is";
  EXPECT_EQ(again["next"]["name"], "sheet02_2.weft");
}

TEST_F(CaptureAtTheRig, HoldsTheSheetsOfAProofAgainstWhatWasAsked) {
  ASSERT_TRUE(begin("check", "sheet.toml")["next"]["pose"]["outline"].is_array());
  lay("sheet tilt=14 azimuth=0");
  Json set = photograph();
  EXPECT_THAT(of(set, "turned.weft")["why"].get<std::string>(),
              HasSubstr("tilted by 14 degrees, its left edge"));
  EXPECT_TRUE(of(set, "turned.weft")["left_out"]) << set;
  lay("sheet turn=90");
  set = photograph();
  EXPECT_TRUE(of(set, "turned_2")["used"]) << of(set, "turned_2");
  EXPECT_NEAR(of(set, "turned_2")["facts"]["turn_deg"].get<double>(), 90, 0.2);
  set = photograph();
  EXPECT_THAT(of(set, "other.weft")["why"].get<std::string>(),
              HasSubstr("nothing has changed since turned_2"));
  lay("sheet other=1");
  EXPECT_TRUE(of(photograph(), "other_2")["used"]);
  set = photograph();
  EXPECT_THAT(of(set, "plane.weft")["why"].get<std::string>(), HasSubstr("lies flat: raise an edge"));
  lay("sheet tilt=15 azimuth=210");
  set = photograph();
  EXPECT_TRUE(set["done"]) << set;
}

TEST_F(CaptureAtTheRig, WorksWithThatOfItsTargetsThatLiesThere) {
  const std::string of_scene = read_text(targets() / "sheet.toml").value();
  ASSERT_TRUE(served_.client().post("/api/v1/calibrations/targets", {{"target", "sheet"}}));
  ASSERT_EQ(read_text(targets() / "sheet.before-1.toml").value(), of_scene);
  const fs::path described = fs::path(begin("moved", nullptr)["folder"].get<std::string>()) / "sheet.toml";
  ASSERT_NE(read_text(described).value(), of_scene) << "the newest, as nobody laid anything yet";
  lay("board");
  EXPECT_THAT(of(photograph(), "moved.weft")["why"].get<std::string>(),
              testing::StartsWith("a board of 10 x 6 squares of 10.98 mm lies there; too few tags"));
  lay("sheet");
  const Json set = photograph();
  EXPECT_TRUE(of(set, "moved_2")["used"]) << set;
  EXPECT_EQ(read_text(described).value(), of_scene);
}

TEST_F(CaptureAtTheRig, AsksAgainForASheetThatLiesOtherwiseAndKeepsIt) {
  begin("moved", "sheet.toml");
  lay("sheet");
  EXPECT_FALSE(of(photograph(), "moved")["facts"].contains("note"));
  lay("sheet tilt=20 azimuth=180");
  const Json other = photograph();
  EXPECT_TRUE(of(other, "tilted")["used"]) << other;
  EXPECT_THAT(of(other, "tilted")["facts"]["note"].get<std::string>(),
              HasSubstr("right edge is raised: raise its left edge"));
  EXPECT_EQ(other["next"]["name"], "tilted_2.weft");
  lay("sheet tilt=20 azimuth=0");
  EXPECT_EQ(photograph()["next"]["name"], "turned.weft");
}

/// With a finder that has as many pixels as a camera's.
class FramingAtTheRig : public CaptureAtTheRig {
 protected:
  FramingAtTheRig() : CaptureAtTheRig(1) {}
};

TEST_F(FramingAtTheRig, SeesInTheFinderThatTheCameraWasKnocked) {
  const Json known = answer(served_.client().get("/api/v1/rig/framing"));
  ASSERT_TRUE(known.is_object());
  EXPECT_NEAR(known["width_mm"].get<double>(), 1536 * 0.13, 0.5) << "a tilted lens with distortion";
  EXPECT_EQ(known["tags"].size(), 4u);
  EXPECT_EQ(known["light"]["values"].size(), 96u);
  const auto framing = [this](int after) {
    EXPECT_TRUE(served_.client().post("/api/v1/rig/light", {{"leds", {1, 3}}}));
    return answer(served_.client().get("/api/v1/rig/live/framing?after=" + std::to_string(after)));
  };
  ASSERT_TRUE(served_.client().post("/api/v1/rig/devices", {{"open", true}}));
  // A picture from the moment when lamps or table change shows neither state; one of the next is whole.
  const auto seen_once = [&framing](const auto& is_so) {
    Json seen = framing(0);
    for (int look = 0; look < 20 && !is_so(seen); ++look) seen = framing(seen["frame"].get<int>());
    return seen;
  };
  const auto is_off = [](double mm) {
    return [mm](const Json& seen) {
      return seen["off_mm"].is_number() && std::abs(seen["off_mm"].get<double>() - mm) < 0.4;
    };
  };
  const Json still = seen_once(is_off(0));
  EXPECT_TRUE(is_off(0)(still)) << still;
  ASSERT_TRUE(served_.rig().say("knock camera x=3 y=-2"));
  const Json knocked = seen_once(is_off(std::hypot(3, 2)));
  EXPECT_TRUE(is_off(std::hypot(3, 2))(knocked)) << knocked;

  begin("moved", "sheet.toml");
  lay("sheet tilt=20 azimuth=0");
  const auto tells_tilt = [](const Json& seen) {
    return seen["says"].get<std::string>().find("tilted by 20 degrees, its left edge raised") !=
           std::string::npos;
  };
  const Json tilted = seen_once(tells_tilt);
  EXPECT_TRUE(tells_tilt(tilted)) << tilted;
  EXPECT_TRUE(tilted["sheet"].is_object()) << tilted;

  begin("board", "board.toml");
  lay("board");
  const Json board = seen_once(
      [](const Json& seen) { return seen["board"].is_object() && seen["corners"].get<int>() >= 6; });
  EXPECT_GE(board["corners"].get<int>(), 6) << board;
  ASSERT_TRUE(board["board"].is_object()) << board;
  for (const Json& corner : board["board"]["corners"]) {
    EXPECT_GT(corner[0].get<double>(), 0.05);
    EXPECT_LT(corner[0].get<double>(), 0.95);
  }
}

}  // namespace
}  // namespace weft::bench
