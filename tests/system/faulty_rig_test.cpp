// SPDX-License-Identifier: Apache-2.0
// Faults of a rig's light and sensor that its files do not tell: what a scan and its solve make of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera/camera_profile.h"
#include "capture/raw/decode_raw.h"
#include "capture/scan/histogram.h"
#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "tests/core/places.h"
#include "tests/system/program.h"
#include "tests/system/workspace.h"
#include "virtual_rig/rig_process.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr double kRows = 272, kReadout_s = 1.0 / 60;
constexpr double kHertz = 500, kRowsOfAPeriod = (kRows - 1) / kReadout_s / kHertz;

class FaultyRig : public testing::Test {
 protected:
  /// A satin of 408 x 272 pixels.
  void start() {
    auto rig = virtual_rig::RigProcess::start({.programs = program_folder(),
                                               .scene = in_sources("testdata/scenes/satin.toml"),
                                               .folder = work_ / "rig",
                                               .megapixels = 0.111});
    ASSERT_TRUE(rig) << rig.error().message();
    rig_ = std::move(*rig);
  }
  void say(const std::string& line) const {
    const Result<std::string> answer = rig_->say(line);
    ASSERT_TRUE(answer) << line << ": " << answer.error().message();
  }
  void run(const std::vector<std::string>& arguments) const {
    const auto weft = rig_->weft(arguments, "weft.log");
    ASSERT_TRUE(weft) << weft.error().message();
    EXPECT_EQ((*weft)->wait(60), 0) << (*weft)->said();
  }
  Session scan(const std::vector<std::string>& more = {}) const {
    const fs::path session = work_ / (std::to_string(++scans_) + ".weft");
    std::vector<std::string> arguments = {"scan", "--fabric", "satin",         "--no-preview",
                                          "-q",   "-o",       session.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run(arguments);
    const Result<Session> read = read_session(session);
    EXPECT_TRUE(read) << read.error().message();
    return read ? *read : Session();
  }
  Json solve(const Session& session) const {
    const fs::path solved = work_ / ("solved" + std::to_string(scans_));
    const Outcome outcome =
        run_weft({"solve", session.folder.string(), "--quality", "fast", "-q", "-o", solved.string()});
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 2) << outcome.error;
    return Json::parse(read_text(solved / "solve.json").value());
  }
  /// Another line in the place of the rig file's.
  void in_rig_file(const std::string& line, const std::string& instead) const {
    std::string toml = read_text(work_ / "rig/rig.toml").value();
    ASSERT_TRUE(write_file(work_ / "rig/rig.toml", toml.replace(toml.find(line), line.size(), instead)));
  }
  static void expect_below(float stop, const Session& session) {
    ASSERT_EQ(session.lit().size(), 10U);
    for (const Shot* shot : session.lit()) {
      RawFrame frame = capture::decode_raw(session.path_of(*shot)).value();
      frame.full = {stop, stop, stop};
      EXPECT_LT(capture::brightness_of(frame).brightest, 0.97) << shot->file;
    }
  }
  static std::vector<std::string> names_of(const Json& warnings) {
    std::vector<std::string> names;
    for (const Json& each : warnings) names.push_back(each["name"]);
    return names;
  }

  Workspace work_;
  std::unique_ptr<virtual_rig::RigProcess> rig_;
  mutable int scans_ = 0;
};

TEST_F(FaultyRig, WhoseDriverGivesPulsesIsSaidToFlickerWithThePeriodOfItsReadout) {
  start();
  ASSERT_TRUE(write_file(work_ / "rig/body.toml",
                         fmt::format("shutter_travel_s = {}\n{}", kReadout_s, capture::nikon_d5100_toml())));
  in_rig_file("profile = \"nikon-d5100\"", "profile = \"body.toml\"");
  say("light pulses 500 0.6 0.5");  // more, and the repeat may differ by over 5 percent
  const Json flickers = solve(scan({"--exposure", "1/30"}));  // 16 periods and two thirds
  EXPECT_THAT(names_of(flickers["warnings"]), Contains("ROWS_FLICKER")) << flickers["warnings"];
  const Json flicker = flickers["conditions"].value("flicker", Json::object());
  EXPECT_NEAR(flicker.value("period_rows", 0.0), kRowsOfAPeriod, 0.02 * kRowsOfAPeriod);
  EXPECT_NEAR(flicker.value("hertz", 0.0), kHertz, 0.02 * kHertz);
}

TEST_F(FaultyRig, ShowsNothingOfPulsesInAnExposureOfWholePeriods) {
  start();
  say("light pulses 500 1 0.5");
  const Json even = solve(scan({"--exposure", "1/125"}));  // four periods
  EXPECT_THAT(names_of(even["warnings"]), Not(Contains("ROWS_FLICKER"))) << even["warnings"];
}

TEST_F(FaultyRig, WhoseReadingsStopBelowWhiteSaturatesThereWhereNobodyMeasuredIt) {
  start();
  say("stops 10000 10000 10000");
  const Json solved = solve(scan());
  EXPECT_GT(solved["status"].value("SATURATED", 0), 0) << "metered to at most 0.8 of 15846";
  EXPECT_THAT(solved["assumed"].dump(),
              HasSubstr("counts stop below the files' white of 15846 (red at 10000"));
}

TEST_F(FaultyRig, WhoseReadingsStopBelowWhiteIsMeteredToWhereItsTestShotsStop) {
  start();
  say("stops 12000 12000 12000");
  for (int led = 1; led <= 10; ++led) say("light dim " + std::to_string(led) + " 30");
  in_rig_file("calibration = \"calibration\"", "");  // and so no light to begin with
  const Session session = scan();
  EXPECT_GT(session.document["exposure"]["meter"]["test_shots"].size(), 0U);
  expect_below(12000, session);
}

TEST_F(FaultyRig, WhoseReadingsStopBelowWhiteIsMeteredToWhereAResponseSawThemStop) {
  start();
  say("stops 11000 11000 11000");
  for (int step = 0; step < 2; ++step) run({"capture", "response", "--once", "-q"});  // lit, and in the dark
  run({"calibrate", "response", (work_ / "rig/sets/response").string(), "--from",
       (work_ / "rig/calibration").string(), "-o", (work_ / "rig/measured").string(), "-q"});
  const Result<Calibration> measured = read_calibration(work_ / "rig/measured");
  ASSERT_TRUE(measured) << measured.error().message();
  ASSERT_EQ(measured->response->levels.value().full_rgb.size(), 3U);
  EXPECT_EQ(measured->response->levels->full_rgb[0], 11000);
  in_rig_file("calibration = \"calibration\"", "calibration = \"measured\"");
  const Session session = scan();
  expect_below(11000, session);
  EXPECT_EQ(solve(session)["status"].value("SATURATED", 0), 0);
}

}  // namespace
}  // namespace weft::test
