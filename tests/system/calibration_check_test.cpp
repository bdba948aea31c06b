// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "calibration/camera/pose.h"
#include "calibration/run/calibrate_patches.h"
#include "calibration/run/check.h"
#include "calibration/run/check_result.h"
#include "calibration/run/history.h"
#include "calibration/run/rig_evidence.h"
#include "calibration/run/update.h"
#include "core/base/files.h"
#include "simulator/captures.h"
#include "simulator/captures_layout.h"
#include "simulator/scene/scene_rig.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solve/run/solve_session.h"
#include "tests/system/checked_rig.h"
#include "tests/system/program.h"

// A rig that is checked, moves, is found out and updated: 600 x 400 pixels over 200 mm of table.

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using simulator::Scene;
using simulator::TargetSettings;
using test::checked_rig;
using testing::HasSubstr;

class CalibrationCheck : public test::CheckedRig {
 protected:
  static void SetUpTestSuite() {
    CheckedRig::SetUpTestSuite();
    simulator::CapturesOptions options;
    options.parts = {"start", "check"};
    const auto captures = simulator::simulate_captures(checked_rig(), root_, options);
    ASSERT_TRUE(captures) << captures.error().message();
  }
};

TEST_F(CalibrationCheck, AcceptsWhatIsRight) {
  const fs::path result = root_ / "accepted";
  const auto outcome = calibration::calibrate_check(
      {.input = root_ / "check", .from = root_ / "rig" / "first", .output = result}, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_TRUE(outcome->report.verdicts.empty()) << outcome->report.verdicts.front().text;
  const auto document = read_json(result / calibration::kCheckResultFile, calibration::kCheckResultSchema, 1);
  ASSERT_TRUE(document) << document.error().message();
  EXPECT_TRUE((*document)["passed"].get<bool>());
  const Json& sheets = (*document)["numbers"]["sheets"];
  ASSERT_EQ(sheets.size(), 3U);
  for (const Json& sheet : sheets) {
    EXPECT_LT(sheet["rms_deg"].get<double>(), 0.1) << sheet.dump();
    EXPECT_EQ(sheet.contains("slope_gain"), sheet["session"] == "plane.weft");
    if (sheet.contains("slope_gain")) {
      EXPECT_NEAR(sheet["slope_gain"].get<double>(), 1, 0.004);
    }
  }
  EXPECT_TRUE(is_there(result / "check.html"));
  EXPECT_THAT(outcome->report.summary, testing::StartsWith("Accepted: 3 sheets"));
  EXPECT_TRUE(outcome->report.numbers["not_checked"].empty())
      << outcome->report.numbers["not_checked"].dump();
}

TEST_F(CalibrationCheck, SaysWhatItDidNotCheck) {
  const fs::path once = root_ / "once.weft";
  fs::copy(root_ / "check" / "other.weft", once, fs::copy_options::recursive);
  Session session = *read_session(once);
  std::erase_if(session.shots, [](const Shot& shot) { return shot.role == ShotRole::kRepeat; });
  ASSERT_TRUE(write_session(session));
  const auto flat = calibration::calibrate_check(
      {.input = once, .from = root_ / "rig" / "first", .sheet = root_ / "check" / "sheet.toml"}, {});
  ASSERT_TRUE(flat) << flat.error().message();
  EXPECT_THAT(flat->report.summary,
              testing::StartsWith("Accepted, with slopes and drift not checked: 1 sheet, flat ones within"));
  const auto tilted = calibration::calibrate_check(
      {.input = root_ / "check" / "plane.weft", .from = root_ / "rig" / "first"}, {});
  ASSERT_TRUE(tilted) << tilted.error().message();
  EXPECT_THAT(tilted->report.summary, testing::StartsWith("Accepted, with flatness not checked: 1 sheet"));
  EXPECT_THAT(tilted->report.summary, testing::Not(HasSubstr("rms"))) << "no sheet was flat";
}

TEST_F(CalibrationCheck, PrintsItsTableAndEndsWithTheCodeOfBadDataWhereItRefuses) {
  const auto check = [&](const fs::path& calibration, const std::string& output) {
    return test::run_weft({"calibrate", "check", (root_ / "check").string(), "--from", calibration.string(),
                           "-o", (root_ / output).string(), "--quiet"});
  };
  const test::Outcome good = check(root_ / "rig" / "first", "good check");
  EXPECT_EQ(good.exit_code, 0) << good.error;
  EXPECT_THAT(good.output,
              testing::AllOf(HasSubstr("Accepted"), HasSubstr("slope gain"), HasSubstr("turned.weft")));
  const test::Outcome bad = check(root_ / "start", "bad check");
  EXPECT_EQ(bad.exit_code, 65) << bad.error;
  EXPECT_THAT(bad.output, testing::AllOf(HasSubstr("Refused"), HasSubstr("slope gain")));
  EXPECT_TRUE(is_there(root_ / "bad check" / "check.html")) << "the report says why";
  // A rig that moved is refused, too.
  simulate(with_table_lower(), "lower.weft");
  const std::string first = (root_ / "rig" / "first").string();
  const auto session = [&](const char* name) {
    return test::run_weft(
        {"calibrate", "check", "--session", (root_ / name).string(), "--from", first, "--quiet"});
  };
  EXPECT_EQ(session("cloth.weft").exit_code, 0);
  EXPECT_EQ(session("lower.weft").exit_code, 65);
}

TEST_F(CalibrationCheck, RefusesTapeMeasuredLights) {
  const auto outcome = calibration::calibrate_check({.input = root_ / "check", .from = root_ / "start"}, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_FALSE(outcome->report.verdicts.empty());
  EXPECT_THAT(outcome->report.summary, HasSubstr("Refused"));
}

TEST_F(CalibrationCheck, RefusesSlopesThatPointAside) {
  Calibration turned = *read_calibration(root_ / "rig" / "first");
  const Mat3 turn = calibration::rotation_of({0, 0, radians(3)});
  for (NearLight& led : std::get<NearLights>(*turned.lights).leds) {
    led.position_mm = turn * led.position_mm;
    led.aim = turn * led.aim;
  }
  ASSERT_TRUE(write_calibration(root_ / "turned", turned));
  const auto outcome =
      calibration::calibrate_check({.input = root_ / "check" / "plane.weft", .from = root_ / "turned"}, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  ASSERT_EQ(outcome->report.verdicts.size(), 1U) << outcome->report.verdicts.back().text;
  EXPECT_EQ(outcome->report.verdicts[0].name, "SLOPES_OFF");
}

TEST_F(CalibrationCheck, ReadsTheKnownPlaneOfASingleSession) {
  const fs::path file = root_ / "check" / "check.toml";
  const calibration::CalibrateCheckOptions options = {.input = root_ / "check" / "plane.weft",
                                                      .from = root_ / "rig" / "first"};
  ASSERT_TRUE(write_file(file, "[[plane]]\nsession = \"plane.weft\"\ntilt_deg = 25\nazimuth_deg = 210\n"));
  const auto outcome = calibration::calibrate_check(options, {});
  ASSERT_TRUE(write_file(file, "[[plane]]\nsession = \"plane.weft\"\ntilt = 25\n"));
  const auto unknown = calibration::calibrate_check(options, {});
  fs::remove(file);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_NEAR(outcome->report.numbers["sheets"][0]["tilt_deg"].get<double>(), 25, 1e-6);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message(), HasSubstr("tilt"));
}

TEST_F(CalibrationCheck, RefusesSessionsOfDifferentCalibrations) {
  const fs::path mixed = root_ / "mixed";
  fs::create_directories(mixed);
  fs::copy(root_ / "check" / "plane.weft", mixed / "a.weft", fs::copy_options::recursive);
  fs::copy(root_ / "check" / "plane.weft", mixed / "b.weft", fs::copy_options::recursive);
  fs::remove_all(mixed / "b.weft" / "calibration");
  fs::copy(root_ / "rig" / "first", mixed / "b.weft" / "calibration", fs::copy_options::recursive);
  Session session = *read_session(mixed / "b.weft");
  session.calibration_id = read_calibration(root_ / "rig" / "first")->id;
  ASSERT_TRUE(write_session(session));
  const auto outcome =
      calibration::calibrate_check({.input = mixed, .sheet = root_ / "check" / "sheet.toml"}, {});
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().message(), HasSubstr("different calibrations"));
}

TEST_F(CalibrationCheck, NamesWhatItCannotCheckWith) {
  const auto empty = calibration::calibrate_check({.input = root_ / "rig"}, {});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().kind, ErrorKind::kNoInput);
  // A session of no sheet.
  const auto cloth = calibration::calibrate_check(
      {.input = root_ / "cloth.weft", .sheet = root_ / "check" / "sheet.toml"}, {});
  ASSERT_FALSE(cloth);
  EXPECT_THAT(cloth.error().message(), HasSubstr("cloth.weft"));
  const auto squares = calibration::calibrate_check({.input = root_ / "check", .square_px = 7}, {});
  ASSERT_FALSE(squares);
  EXPECT_EQ(squares.error().kind, ErrorKind::kUsage);
  const auto there =
      calibration::calibrate_check_rig({.session = root_ / "nothing", .output = root_ / "rig"}, {});
  ASSERT_FALSE(there);
  EXPECT_EQ(there.error().kind, ErrorKind::kCannotCreate) << "the output is looked at first";
}

TEST_F(CalibrationCheck, FindsNothingOnARigThatStoodStill) {
  const auto rig =
      calibration::look_at_rig({.session = root_ / "cloth.weft", .from = root_ / "rig" / "first"}, {});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_TRUE(rig->movement.changes.empty());
  EXPECT_EQ(rig->movement.corners, 16);
  EXPECT_EQ(rig->movement.readings, 40);
  const auto update = calibration::calibrate_update(
      {.session = root_ / "cloth.weft", .from = root_ / "rig" / "first", .output = root_ / "needless"}, {});
  ASSERT_FALSE(update);
  EXPECT_THAT(update.error().message(), HasSubstr("nothing to update"));
  EXPECT_FALSE(is_there(root_ / "needless"));
}

TEST_F(CalibrationCheck, SaysWhereWhatIsSeenIsExplainedWorseThanUsual) {
  calibration::CheckRigOptions options = {.session = root_ / "cloth.weft", .from = root_ / "rig" / "first"};
  const auto usual = calibration::calibrate_check_rig(options, {});
  ASSERT_TRUE(usual) << usual.error().message();
  EXPECT_THAT(usual->warnings, testing::IsEmpty());
  // The same pictures, held against noise that is taken for less than it is, and told without changes.
  options.movement.most_changes = 0;
  const double chi_square = usual->report.numbers["chi_square_after"].get<double>();
  const double share = std::sqrt(chi_square / 3);
  options.movement.corner_sigma_px *= share;
  options.movement.flicker *= share;
  options.movement.reading_sigma *= share;
  options.movement.few_pixels *= share;
  options.movement.tilt_sigma_deg *= share;
  const auto worse = calibration::calibrate_check_rig(options, {});
  ASSERT_TRUE(worse) << worse.error().message();
  EXPECT_NEAR(worse->report.numbers["chi_square_after"].get<double>(), 3, 0.9);
  EXPECT_TRUE(worse->report.verdicts.empty()) << worse->report.verdicts.front().text;
  ASSERT_EQ(worse->warnings.size(), 1U);
  EXPECT_THAT(worse->warnings[0], HasSubstr("explained worse than usual"));
}

TEST_F(CalibrationCheck, WhatIsKnownOfLedsGoesWithThemWhereTheyAreExchanged) {
  Calibration known = *read_calibration(root_ / "rig" / "first");
  const std::vector<double> variances = {1e-6, 4e-6, 9e-6};
  known.light_covariance =
      ParameterCovariance{{"led02.log_flux", "led05.log_flux", "led07.log_flux"}, std::vector<double>(9)};
  for (std::size_t i = 0; i < 3; ++i) known.light_covariance->matrix[4 * i] = variances[i];
  known.light_covariance->matrix[1] = known.light_covariance->matrix[3] = 5e-7;
  known.camera_covariance = ParameterCovariance{{"fx"}, {0.04}};
  ASSERT_TRUE(write_calibration(root_ / "known", known));
  Scene scene = checked_rig();
  const NearLights lights = simulator::rig_of(scene)->leds;
  scene.camera.exposure_us = simulator::rig_of(scene)->exposure_us;
  scene.lights.rings.clear();
  for (const NearLight& led : lights.leds)
    scene.lights.leds.push_back({led.position_mm, led.aim, led.mu, led.flux_rgb});
  std::swap(scene.lights.leds[1], scene.lights.leds[4]);
  simulate(scene, "swapped.weft");
  const auto update = calibration::calibrate_update(
      {.session = root_ / "swapped.weft", .from = root_ / "known", .output = root_ / "exchanged"}, {});
  ASSERT_TRUE(update) << update.error().message();
  const Calibration& now = update->calibration;
  EXPECT_LT(length(std::get<NearLights>(*now.lights).leds[1].position_mm - lights.leds[4].position_mm), 1e-6);
  const auto variance = [&](const std::string& a, const std::string& b) {
    const ParameterCovariance& c = *now.light_covariance;
    const auto at = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(c.parameters.begin(), c.parameters.end(), name) -
                                      c.parameters.begin());
    };
    return c.matrix.at(at(a) * c.parameters.size() + at(b));
  };
  EXPECT_EQ(variance("led05.log_flux", "led05.log_flux"), variances[0]);
  EXPECT_EQ(variance("led02.log_flux", "led02.log_flux"), variances[1]);
  EXPECT_EQ(variance("led07.log_flux", "led07.log_flux"), variances[2]);
  EXPECT_EQ(variance("led02.log_flux", "led05.log_flux"), 5e-7);
  EXPECT_TRUE(now.camera_covariance) << "the camera did not move";
}

TEST_F(CalibrationCheck, ATableThatSankIsFoundUpdatedAndInTheHistory) {
  simulate(with_table_lower(), "sunk.weft");
  const fs::path first = root_ / "rig" / "first", second = root_ / "rig" / "second";
  const auto check = calibration::calibrate_check_rig(
      {.session = root_ / "sunk.weft", .from = first, .output = root_ / "rig" / "check"}, {});
  ASSERT_TRUE(check) << check.error().message();
  ASSERT_EQ(check->report.verdicts.size(), 1U);
  EXPECT_EQ(check->report.verdicts[0].name, "TABLE_MOVED");

  const auto update =
      calibration::calibrate_update({.session = root_ / "sunk.weft", .from = first, .output = second}, {});
  ASSERT_TRUE(update) << update.error().message();
  EXPECT_NE(update->calibration.id, read_calibration(first)->id);
  EXPECT_FALSE(update->calibration.camera_covariance) << "its pose is known as the movement is";
  EXPECT_THAT(update->warnings, testing::Contains(HasSubstr("covariance of the camera was left out")));
  const auto again = calibration::look_at_rig({.session = root_ / "sunk.weft", .from = second}, {});
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_TRUE(again->movement.changes.empty());

  // The old session keeps its calibration and can be solved with the new one.
  const auto solved = solve::solve_session({root_ / "sunk.weft", second, {}},
                                           {.method = "fast", .output = root_ / "solved"}, {});
  ASSERT_TRUE(solved) << solved.error().message();
  EXPECT_EQ(solved->facts.input->calibration, update->calibration.id);
  EXPECT_NE(read_session(root_ / "sunk.weft")->calibration_id, update->calibration.id);

  const auto history = calibration::calibrate_history({root_ / "rig", {}, root_ / "page"}, {});
  ASSERT_TRUE(history) << history.error().message();
  EXPECT_EQ(history->report.numbers["calibrations"].size(), 2U);
  EXPECT_EQ(history->report.numbers["checks"].size(), 1U);
  EXPECT_NEAR(history->report.numbers["calibrations"][1]["led_moved_most_mm"].get<double>(), 2, 0.2);
  EXPECT_TRUE(is_there(root_ / "page/history.html"));
}

TEST_F(CalibrationCheck, PatchesAreMeasuredByTheLightThatIsKnown) {
  const auto exact = read_calibration(root_ / "rig" / "first");
  std::string text;
  for (const WhitePatch& patch : exact->patches) {
    text += "[[patch]]\npolygon_px = [";
    for (const auto& [x, y] : patch.polygon_px)
      text += "[" + std::to_string(x) + ", " + std::to_string(y) + "],";
    text += "]\n";
  }
  ASSERT_TRUE(write_file(root_ / "patches.toml", text));
  const auto measured =
      calibration::calibrate_patches({.session = root_ / "cloth.weft", .output = root_ / "with patches"}, {});
  ASSERT_TRUE(measured) << measured.error().message();
  ASSERT_EQ(measured->calibration.patches.size(), 4U);
  for (const WhitePatch& patch : measured->calibration.patches) {
    for (const double r : patch.reflectance_rgb) EXPECT_NEAR(r, 0.88, 0.003);
    EXPECT_EQ(patch.height_mm, 0) << "as high as the tags that the calibration knows: none";
    EXPECT_EQ(patch.delta, 0);
  }
  // A corner outside the frame.
  ASSERT_TRUE(write_file(root_ / "wrong.toml", "[[patch]]\npolygon_px = [[1, 1], [700, 1], [1, 30]]\n"));
  const auto wrong = calibration::calibrate_patches(
      {.session = root_ / "cloth.weft", .patches = root_ / "wrong.toml", .output = root_ / "never"}, {});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message(), HasSubstr("patch 1"));
  ASSERT_TRUE(write_file(root_ / "wrong.toml", "[[patch]]\npolygon = [[1, 1], [70, 1], [1, 30]]\n"));
  const auto misspelt = calibration::calibrate_patches(
      {.session = root_ / "cloth.weft", .patches = root_ / "wrong.toml", .output = root_ / "never"}, {});
  ASSERT_FALSE(misspelt);
  EXPECT_THAT(misspelt.error().message(),
              HasSubstr("patch 1: polygon: there is no such key; the nearest is polygon_px"));
  EXPECT_FALSE(is_there(root_ / "never"));
}

TEST_F(CalibrationCheck, PatchesOfPaperThatIsNotLambertianAboveTheClothSayThatNothingDrifted) {
  Scene scene = checked_rig();
  scene.geometry.cloth_height_mm = -6;
  for (TargetSettings& target : scene.targets) {
    if (kind_of(target.pattern) == simulator::TargetKind::kPaper) target.sheet.non_lambertian = 0.05;
  }
  simulate(scene, "paper.weft");
  std::string text;
  const Result<Calibration> first = read_calibration(root_ / "rig" / "first");
  ASSERT_TRUE(first) << first.error().message();
  for (const WhitePatch& patch : first->patches) {
    text += "[[patch]]\nheight_mm = 0.3\ndelta = 0.05\npolygon_px = [";
    for (const auto& [x, y] : patch.polygon_px) text += fmt::format("[{}, {}], ", x, y);
    text += "]\n";
  }
  ASSERT_TRUE(write_file(root_ / "paper.toml", text));
  const auto measured = calibration::calibrate_patches(
      {.session = root_ / "paper.weft", .patches = root_ / "paper.toml", .output = root_ / "with paper"}, {});
  ASSERT_TRUE(measured) << measured.error().message();
  EXPECT_EQ(measured->calibration.patches[0].delta, 0.05);
  EXPECT_EQ(measured->calibration.patches[0].height_mm, 0.3);
  const auto plan = solve::plan_session({root_ / "paper.weft", root_ / "with paper", {}});
  ASSERT_TRUE(plan) << plan.error().message();
  const auto loaded = solve::load_photographs(*plan, {});
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_THAT(loaded->conditions.warnings, testing::IsEmpty());
  ASSERT_EQ(loaded->conditions.facts.drift.size(), 10U);
  for (const ConditionedLed& led : loaded->conditions.facts.drift)
    EXPECT_NEAR(led.factor, 1, 0.002) << "LED " << led.led;
}

TEST_F(CalibrationCheck, ADimmedLedIsFoundInTheLightOfThePatches) {
  Scene scene = checked_rig();
  const NearLights lights = simulator::rig_of(scene)->leds;
  scene.camera.exposure_us = simulator::rig_of(scene)->exposure_us;
  scene.lights.rings.clear();
  for (const NearLight& led : lights.leds)
    scene.lights.leds.push_back({led.position_mm, led.aim, led.mu, led.flux_rgb});
  for (double& flux : *scene.lights.leds[3].flux_rgb) flux *= 0.95;
  simulate(scene, "dim.weft");
  const auto check =
      calibration::calibrate_check_rig({.session = root_ / "dim.weft", .from = root_ / "rig" / "first"}, {});
  ASSERT_TRUE(check) << check.error().message();
  ASSERT_EQ(check->report.verdicts.size(), 1U);
  EXPECT_EQ(check->report.verdicts[0].name, "LED_FADED");
  EXPECT_EQ(check->report.numbers["changes"][0]["led"], 4);
  EXPECT_NEAR(check->report.numbers["changes"][0]["factor"].get<double>(), 0.95, 0.005);
  const auto update = calibration::calibrate_update(
      {.session = root_ / "dim.weft", .from = root_ / "rig" / "first", .output = root_ / "dim"}, {});
  EXPECT_TRUE(update) << update.error().message();

  // By tags alone nothing is said of LEDs.
  Calibration no_patch = *read_calibration(root_ / "rig" / "first");
  no_patch.patches.clear();
  ASSERT_TRUE(write_calibration(root_ / "no patch", no_patch));
  const auto blind =
      calibration::calibrate_check_rig({.session = root_ / "dim.weft", .from = root_ / "no patch"}, {});
  ASSERT_TRUE(blind) << blind.error().message();
  EXPECT_THAT(blind->report.summary, HasSubstr("LEDs were not checked"));
}

TEST_F(CalibrationCheck, NamesTheSessionsBetweenTheLastGoodCheckAndTheMove) {
  const fs::path rig = root_ / "old rig", sessions = root_ / "sessions";
  fs::create_directories(sessions);
  fs::create_directories(rig);
  fs::copy(root_ / "rig" / "first", rig / "first");
  const auto calibration = read_calibration(rig / "first");
  ASSERT_TRUE(calibration);
  calibration::CalibrationReport good, bad;
  good.part = bad.part = "check";
  good.numbers = {{"readings", 40}};
  bad.numbers = {{"cost_mean_deg", 0.4}, {"cost_worst_deg", 0.9}, {"changes", Json::array()}};
  bad.verdicts = {{"TABLE_MOVED", "The table has moved", "update"}};
  ASSERT_TRUE(
      calibration::write_check_result(rig / "a", "session", *calibration, good, "2026-03-02T08:00:00Z"));
  ASSERT_TRUE(
      calibration::write_check_result(rig / "b", "session", *calibration, bad, "2026-03-04T08:00:00+01:00"));
  // The move was put right afterwards.
  ASSERT_TRUE(
      calibration::write_check_result(rig / "c", "session", *calibration, good, "2026-03-05T08:00:00Z"));
  const char* kTimes[] = {"2026-03-01T12:00:00Z", "2026-03-03T12:00:00Z", "2026-03-04T07:30:00Z", "",
                          "2026-03-06T12:00:00Z"};
  for (std::size_t i = 0; i < 5; ++i) {
    const fs::path folder = sessions / ("s" + std::to_string(i) + ".weft");
    fs::create_directories(folder);
    Session session = *read_session(root_ / "cloth.weft");
    session.folder = folder;
    session.document = {};
    session.calibration_id = calibration->id;
    for (Shot& shot : session.shots) shot.time = kTimes[i];
    const auto written = write_session(session);
    ASSERT_TRUE(written) << written.error().message();
  }
  const auto history = calibration::calibrate_history({rig, sessions, {}}, {});
  ASSERT_TRUE(history) << history.error().message();
  ASSERT_EQ(history->affected.size(), 2U);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_EQ(history->affected[i].folder.filename(), i == 0 ? "s1.weft" : "s2.weft");
    EXPECT_EQ(history->affected[i].predicted_mean_deg, 0.4);
    EXPECT_EQ(history->affected[i].after_move, i == 1) << "the check was at 07:00 UTC";
  }
  ASSERT_EQ(history->warnings.size(), 1U);
  EXPECT_THAT(history->warnings[0], HasSubstr("s3.weft"));
  EXPECT_THAT(history->report.summary,
              HasSubstr("2 of 5 sessions affected by a move, 1 without a time cannot be told"));
}

TEST_F(CalibrationCheck, RefusesAHistoryOfSessionsThatAreNotThere) {
  const auto history = calibration::calibrate_history({root_ / "rig", root_ / "nowhere", {}}, {});
  ASSERT_FALSE(history) << history->report.summary;
  EXPECT_EQ(history.error().kind, ErrorKind::kNoInput);
  EXPECT_THAT(history.error().message(), HasSubstr("nowhere"));
}

TEST_F(CalibrationCheck, TagsAloneDoNotClearLedsAndSheetsPredictNoError) {
  const fs::path rig = root_ / "blind rig", sessions = root_ / "later sessions";
  fs::create_directories(sessions / "s.weft");
  fs::create_directories(rig);
  fs::copy(root_ / "rig" / "first", rig / "first");
  const auto calibration = read_calibration(rig / "first");
  ASSERT_TRUE(calibration);
  calibration::CalibrationReport tags, faded, sheets;
  tags.part = faded.part = sheets.part = "check";
  tags.numbers = {{"corners", 16}, {"readings", 0}};
  faded.numbers = {{"cost_mean_deg", 0.4}, {"changes", {{{"change", "LED_FADED"}, {"led", 4}}}}};
  faded.verdicts = sheets.verdicts = {{"LED_FADED", "LED 4 has faded", "update"}};
  ASSERT_TRUE(
      calibration::write_check_result(rig / "tags", "session", *calibration, tags, "2026-03-03T08:00:00Z"));
  ASSERT_TRUE(
      calibration::write_check_result(rig / "faded", "session", *calibration, faded, "2026-03-04T08:00:00Z"));
  Session session = *read_session(root_ / "cloth.weft");
  session.folder = sessions / "s.weft";
  session.document = {};
  session.calibration_id = calibration->id;
  for (Shot& shot : session.shots) shot.time = "2026-03-02T12:00:00Z";
  ASSERT_TRUE(write_session(session));
  const auto history = calibration::calibrate_history({rig, sessions, {}}, {});
  ASSERT_TRUE(history) << history.error().message();
  ASSERT_EQ(history->affected.size(), 1U) << "tags do not tell whether the LED had faded already";
  EXPECT_EQ(history->affected[0].predicted_mean_deg, 0.4);

  fs::remove_all(rig / "faded");
  ASSERT_TRUE(calibration::write_check_result(rig / "sheets", "sheets", *calibration, sheets,
                                              "2026-03-04T08:00:00Z"));
  const auto by_sheets = calibration::calibrate_history({rig, sessions, {}}, {});
  ASSERT_TRUE(by_sheets) << by_sheets.error().message();
  ASSERT_EQ(by_sheets->affected.size(), 1U);
  EXPECT_FALSE(by_sheets->affected[0].predicted_mean_deg);
}

}  // namespace
}  // namespace weft::app
