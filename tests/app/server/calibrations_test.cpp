// SPDX-License-Identifier: Apache-2.0
// The calibrations beside a rig file over HTTP: listed, accepted, and what a check says of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

using testing::HasSubstr;
TEST(CalibrationsOfARig, ScansAtOnceWithTheCalibrationThatWasAccepted) {
  ScriptedRig scripted("accepts");
  const std::filesystem::path folder = scripted.rig.file.parent_path();
  const std::filesystem::path one = folder / "calibrations" / "one";
  std::filesystem::create_directories(folder / "calibrations" / "check");
  std::filesystem::copy(source_folder() / "testdata/schemas/weft.calibration-1.2-measured", one,
                        std::filesystem::copy_options::recursive);
  ASSERT_TRUE(
      write_file(scripted.rig.file, "name = \"scripted\"\nleds = 3\n\n[scan]\nsessions = \"scans\"\n"));
  const Result<Calibration> read = read_calibration(one);
  ASSERT_TRUE(read) << read.error().message();
  const auto server = scripted.started();
  const int port = server->port();
  const Answer list = ask(port, "GET", "/api/v1/calibrations");
  ASSERT_EQ(list.status, 200) << list.body;
  const Json listed = list.json()["calibrations"];
  ASSERT_EQ(listed.size(), 1U) << listed;
  EXPECT_EQ(listed[0]["folder"], "calibrations/one");
  EXPECT_EQ(listed[0]["is_rigs"], false);
  EXPECT_EQ(listed[0]["check"], Json());

  constexpr const char* kAccept = "/api/v1/calibrations/accept";
  const Answer tried = ask(port, "POST", kAccept, R"({"calibration": "calibrations/one", "dry_run": true})");
  EXPECT_EQ(tried.status, 200) << tried.body;
  EXPECT_EQ(tried.json()["accepted"], false);
  EXPECT_EQ(ask(port, "GET", "/api/v1/calibrations").json()["calibrations"][0]["is_rigs"], false);
  const Answer accepted = ask(port, "POST", kAccept, R"({"calibration": "calibrations/one"})");
  EXPECT_EQ(accepted.status, 200) << accepted.body;
  EXPECT_EQ(accepted.json()["to"], read->id);
  EXPECT_THAT(accepted.body, HasSubstr("nobody has checked it"));
  EXPECT_EQ(ask(port, "GET", "/api/v1/calibrations").json()["calibrations"][0]["is_rigs"], true);

  ASSERT_TRUE(write_json(folder / "calibrations" / "check" / "result.json",
                         {{"schema", "weft.calibration-check/1"},
                          {"date", "2026-11-23T10:00:00Z"},
                          {"of", "session"},
                          {"calibration", read->id},
                          {"passed", false},
                          {"numbers", {{"cost_mean_deg", 0.5}, {"cost_worst_deg", 1}}}}));
  EXPECT_EQ(ask(port, "POST", "/api/v1/scan", R"({"fabric": "satin"})").json()["error"]["code"], "rig_moved");
  const Json history = ask(port, "GET", "/api/v1/calibrations/history").json();
  EXPECT_EQ(history["summary"], "1 calibration and 1 check") << history;
}

TEST(CalibrationsOfARig, AcceptsNoCalibrationThatCannotBeTheRigs) {
  ScriptedRig scripted("refuses");
  const std::filesystem::path folder = scripted.rig.file.parent_path();
  std::filesystem::create_directories(folder / "empty");
  const auto server = scripted.started();
  struct Case {
    const char* body;
    int status;
  };
  for (const Case& c :
       {Case{R"({})", 400}, Case{R"({"calibration": "../elsewhere"})", 400},
        Case{R"({"calibration": "nowhere"})", 404}, Case{R"({"calibration": "empty"})", 404},
        Case{R"({"calibration": 7})", 400}, Case{R"({"calibration": "empty", "dry_run": 1})", 400}}) {
    const Answer answer = ask(server->port(), "POST", "/api/v1/calibrations/accept", c.body);
    EXPECT_EQ(answer.status, c.status) << c.body << ": " << answer.body;
  }
}

}  // namespace
}  // namespace weft::app
