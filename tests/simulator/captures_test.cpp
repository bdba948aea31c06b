// SPDX-License-Identifier: Apache-2.0
#include "simulator/captures.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "capture/rig.h"
#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "simulator/captures_layout.h"
#include "simulator/targets/target.h"
#include "tests/simulator/output.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

fs::path absent_folder() {
  const fs::path folder = fs::path(testing::TempDir()) / "weft_captures" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  return folder;
}

/// 96 x 64 pixels of 200 x 133 mm, four LEDs, no noise.
Scene small_rig() {
  Scene scene;
  scene.camera.width = 96;
  scene.camera.height = 64;
  scene.camera.mm_per_pixel = 200.0 / 96;
  scene.lights.rings = {{4, 40, 20, 600}};
  scene.effects.near_light = true;
  return scene;
}

CapturesReport taken(const Scene& rig, const fs::path& folder, const std::vector<std::string>& parts) {
  CapturesOptions options;
  options.parts = parts;
  options.boards = 2;
  const Result<CapturesReport> report = simulate_captures(rig, folder, options);
  EXPECT_TRUE(report) << report.error().message();
  return report ? *report : CapturesReport();
}

TEST(Photograph, UnderTwoLedsIsTheSumOfBoth) {
  const fs::path folder = absent_folder();
  fs::create_directories(folder);
  const Scene scene = small_rig();
  const std::vector<int> kLit[] = {{1}, {2}, {1, 2}};
  std::vector<RawFrame> frames;
  for (const auto& lit : kLit) {
    const fs::path file = folder / (std::to_string(frames.size()) + ".dng");
    const Result<void> written = simulate_photograph(scene, {lit, 8000.0}, file, {});
    ASSERT_TRUE(written) << written.error().message();
    frames.push_back(decoded(file));
  }
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 96; ++x) {
      const double sum = frames[0].counts(x, y) + frames[1].counts(x, y) - 600.0;
      ASSERT_NEAR(frames[2].counts(x, y), sum, 1) << x << ", " << y;
    }
  }
}

TEST(Photograph, TakenLaterHasOtherNoiseOnTheSameSensor) {
  const fs::path folder = absent_folder();
  fs::create_directories(folder);
  Scene scene = small_rig();
  scene.effects.noise = scene.effects.uneven_response = true;
  scene.camera.defects.response_percent = 20;
  SimulateOptions later;
  later.takes_before = 5;
  ASSERT_TRUE(simulate_photograph(scene, {{1}, 20000.0}, folder / "a.dng", {}));
  ASSERT_TRUE(simulate_photograph(scene, {{1}, 20000.0}, folder / "b.dng", later));
  const RawFrame a = decoded(folder / "a.dng"), b = decoded(folder / "b.dng");
  int same = 0;
  double differences = 0, departures = 0;
  for (int y = 1; y < 63; ++y) {
    for (int x = 0; x < 92; ++x) {
      same += a.counts(x, y) == b.counts(x, y) ? 1 : 0;
      differences += std::pow(a.counts(x, y) - b.counts(x, y), 2);
      departures += std::pow(a.counts(x, y) - a.counts(x + 4, y), 2);
    }
  }
  EXPECT_LT(same, 62 * 92 / 10);
  EXPECT_LT(10 * differences, departures);
}

TEST(Photograph, RefusesALedThatIsNotThereOrTwice) {
  const fs::path folder = absent_folder();
  fs::create_directories(folder);
  for (const std::vector<int>& leds : {std::vector{1, 1}, std::vector{5}, std::vector{0, 1}}) {
    const Result<void> refused = simulate_photograph(small_rig(), {leds, {}}, folder / "a.dng", {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  }
}

TEST(Captures, OfTheCameraAreBoardsAndATable) {
  const fs::path folder = absent_folder();
  const CapturesReport report = taken(small_rig(), folder, {"camera"});
  EXPECT_THAT(names_in(folder / "camera"),
              UnorderedElementsAre("board01.dng", "board02.dng", "table01.dng", "board.toml"));
  EXPECT_EQ(report.photographs, 3);
  const RawFrame frame = decoded(folder / "camera" / "board01.dng");
  int brightest = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 96; ++x) brightest = std::max(brightest, static_cast<int>(frame.counts(x, y)));
  }
  EXPECT_GT(brightest, 600 + 0.6 * (15520 - 600));
  EXPECT_LT(brightest, 600 + 0.9 * (15520 - 600));
}

TEST(Captures, OfTheResponseArePairsAtFourExposures) {
  const fs::path folder = absent_folder();
  taken(small_rig(), folder, {"response"});
  EXPECT_THAT(names_in(folder / "response"),
              UnorderedElementsAre("dark", "led01", "led02", "led01+led02", "scale"));
  for (const char* name : {"dark", "led01", "led02", "led01+led02"}) {
    std::multiset<double> exposures;
    for (const std::string& file : names_in(folder / "response" / name))
      exposures.insert(decoded(folder / "response" / name / file).shot.exposure_us);
    EXPECT_EQ(exposures.size(), 8U) << name;
    EXPECT_EQ(std::set<double>(exposures.begin(), exposures.end()).size(), 4U) << name;
  }
}

TEST(Captures, OfTheLightsAreFiveSheetsThatHoldTheStartingCalibration) {
  const fs::path folder = absent_folder();
  taken(small_rig(), folder, {"start", "lights"});
  EXPECT_THAT(names_in(folder / "lights"),
              UnorderedElementsAre("sheet01.weft", "sheet02.weft", "sheet03.weft", "sheet04.weft",
                                   "sheet05.weft", "sheet.toml", "rig.toml"));
  const Result<Calibration> start = read_calibration(folder / "start");
  ASSERT_TRUE(start) << start.error().message();
  const Result<Session> session = read_session(folder / "lights" / "sheet03.weft");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->calibration_id, start->id);
  EXPECT_FALSE(is_there(folder / "lights" / "sheet03.weft" / "truth"));
  const auto& leds = std::get<NearLights>(*start->lights).leds;
  ASSERT_EQ(leds.size(), 4U);
  const double zenith = radians(40), azimuth = radians(20);
  const Vec3 real = {600 * std::sin(zenith) * std::cos(azimuth), 600 * std::sin(zenith) * std::sin(azimuth),
                     600 * std::cos(zenith)};
  EXPECT_NEAR(length(leds[0].position_mm - real), 10, 1e-6);
  const Result<capture::Rig> rig = capture::read_rig(folder / "lights" / "rig.toml");
  ASSERT_TRUE(rig) << rig.error().message();
  ASSERT_TRUE(rig->lights);
  ASSERT_EQ(rig->lights->leds.size(), 4U);
  EXPECT_NEAR(length(rig->lights->leds[0].position_mm - leds[0].position_mm), 0, 0.1);
}

TEST(Captures, FlickerAndFadeAsTheSceneSays) {
  const fs::path folder = absent_folder();
  Scene scene = small_rig();
  taken(scene, folder / "steady", {"lights"});
  scene.effects.led_drift = true;
  scene.lights.drift = 0.1;
  scene.lights.flicker = 0.02;
  taken(scene, folder / "real", {"lights"});
  const auto light_of = [&](const char* rig, int sheet, int led) {
    const fs::path session = folder / rig / "lights" / fmt::format("sheet{:02}.weft", sheet);
    const RawFrame frame =
        decoded(session / read_session(session)->lit()[static_cast<std::size_t>(led)]->file);
    double sum = 0;
    for (int y = 24; y < 40; ++y) {
      for (int x = 36; x < 60; ++x) sum += frame.counts(x, y) - 600.0;
    }
    return sum;
  };
  double last_over_first = 0, scatter = 0;
  for (int sheet = 1; sheet <= 5; ++sheet) {
    const auto gain = [&](int led) { return light_of("real", sheet, led) / light_of("steady", sheet, led); };
    last_over_first += gain(3) / gain(0) / 5;
    scatter += std::pow(gain(0) - 1, 2) / 5;
  }
  EXPECT_NEAR(last_over_first, 0.9, 0.03) << "4 LEDs, 2 percent of flicker";
  EXPECT_GT(std::sqrt(scatter), 0.007) << "LED 1 of every session";
  EXPECT_LT(std::sqrt(scatter), 0.04);
}

TEST(Captures, ForChecksEndWithARepeat) {
  const fs::path folder = absent_folder();
  const CapturesReport report = taken(small_rig(), folder, {"check"});
  EXPECT_EQ(report.sessions, 3);
  for (const char* name : {"turned.weft", "other.weft", "plane.weft"}) {
    const Result<Session> session = read_session(folder / "check" / name);
    ASSERT_TRUE(session) << session.error().message();
    EXPECT_EQ(std::count_if(session->shots.begin(), session->shots.end(),
                            [](const Shot& shot) { return shot.role == ShotRole::kRepeat; }),
              1);
  }
}

TEST(Captures, OfASceneWithoutAChartHaveNoColour) {
  const fs::path folder = absent_folder();
  CapturesOptions options;
  options.parts = {"color"};
  const Result<CapturesReport> refused = simulate_captures(small_rig(), folder, options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
}

TEST(Captures, AreRefusedForAnUnknownPartAndNeverOverwritten) {
  const fs::path folder = absent_folder();
  CapturesOptions options;
  options.parts = {"lens"};
  const Result<CapturesReport> unknown = simulate_captures(small_rig(), folder, options);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message(), testing::HasSubstr("lens"));
  taken(small_rig(), folder, {"start"});
  options.parts = {"start"};
  const Result<CapturesReport> again = simulate_captures(small_rig(), folder, options);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kCannotCreate);
}

TEST(CapturesLayout, KeepsEveryBoardAndSheetInsideTheFrame) {
  Scene scene = small_rig();
  scene.effects.distortion = true;
  scene.camera.pose = {.tilt_deg = 3, .azimuth_deg = 50, .x_mm = 4};
  const Result<SceneRig> rig = rig_of(scene);
  ASSERT_TRUE(rig) << rig.error().message();
  const SheetLayout sheet = sheet_layout(scene, rig->camera, five_poses());
  EXPECT_GT(sheet.width_mm, 150);
  std::vector<TargetSettings> all = board_poses(scene, rig->camera, board_pattern(scene), 15, 1);
  for (const CapturePose& pose : five_poses()) {
    const std::vector<TargetSettings> targets = laid(sheet, pose, TargetSettings());
    all.insert(all.end(), targets.begin(), targets.end());
  }
  for (const TargetSettings& settings : all) {
    const Result<Target> target = Target::make(settings, 1, 0);
    ASSERT_TRUE(target) << target.error().message();
    for (const double u : {-0.5, 0.5}) {
      for (const double v : {-0.5, 0.5}) {
        const Vec3 corner = target->place_mm(u * target->width_mm(), v * target->height_mm());
        const Vec3 p = project(rig->camera, corner);
        EXPECT_GT(corner.z, 0);
        EXPECT_TRUE(p.x > 0 && p.x < 95 && p.y > 0 && p.y < 63) << p.x << ", " << p.y;
      }
    }
  }
}

TEST(CapturesLayout, SpreadsBoardsOverFrameAndTilts) {
  const Scene scene = small_rig();
  const Result<SceneRig> rig = rig_of(scene);
  const std::vector<TargetSettings> boards = board_poses(scene, rig->camera, board_pattern(scene), 15, 1);
  double left = 0, right = 0, lower = 0, upper = 0, least = 90, most = 0;
  for (const TargetSettings& board : boards) {
    left = std::min(left, board.centre_mm.x), right = std::max(right, board.centre_mm.x);
    lower = std::min(lower, board.centre_mm.y), upper = std::max(upper, board.centre_mm.y);
    least = std::min(least, board.tilt_deg), most = std::max(most, board.tilt_deg);
  }
  EXPECT_LT(left, -20);
  EXPECT_GT(right, 20);
  EXPECT_LT(lower, -10);
  EXPECT_GT(upper, 10);
  EXPECT_LT(least, 15);
  EXPECT_GT(most, 25);
}

}  // namespace
}  // namespace weft::simulator
