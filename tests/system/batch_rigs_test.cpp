// SPDX-License-Identifier: Apache-2.0
// An archive of three rigs, one of which was calibrated wrongly.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <map>

#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "tests/system/batch_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Gives a session a calibration of another rig, changed.
void give_rig(const fs::path& session, const std::string& rig,
              const std::function<void(Calibration&)>& change) {
  Result<Calibration> calibration = read_calibration(session / "calibration");
  ASSERT_TRUE(calibration) << calibration.error().message();
  calibration->subject.rig = rig;
  change(*calibration);
  const fs::path written = session / "calibration-new";
  const Result<Calibration> own = write_calibration(written, *calibration);
  ASSERT_TRUE(own) << own.error().message();
  fs::remove_all(session / "calibration");
  fs::rename(written, session / "calibration");
  edit_json(session / "session.json", [&](Json& json) {
    json["rig"] = rig;
    json["calibration"] = own->id;
  });
}

// As a rig that was turned about its axis since, and of which two LEDs stand elsewhere than was written down.
void misplace_lights(Calibration& calibration) {
  auto& leds = std::get<NearLights>(*calibration.lights).leds;
  const double cosine = std::cos(radians(8)), sine = std::sin(radians(8));
  const auto turned = [&](Vec3 v) { return Vec3{cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z}; };
  for (auto& led : leds) {
    led.position_mm = turned(led.position_mm);
    led.aim = turned(led.aim);
  }
  leds[1].position_mm = leds[1].position_mm + Vec3{90, -60, 40};
  leds[5].position_mm = leds[5].position_mm + Vec3{-70, 80, -50};
}

TEST_F(BatchTest, OfThreeRigsTheReportNamesTheOneFirstThatWasCalibratedWrongly) {
  fill_archive(6);
  for (int i = 0; i < 6; ++i) {
    const char rig = static_cast<char>('a' + i % 3);
    give_rig(session(i), fmt::format("rig {}", rig), [&](Calibration& calibration) {
      if (rig == 'b') misplace_lights(calibration);
    });
    // Mixed rigs: one of them has a LED missing.
    if (rig == 'c') edit_json(session(i) / "session.json", [](Json& json) { json["left_out"] = {4}; });
  }
  plan();
  ASSERT_EQ(run({"-q", "--jobs", "2"}).exit_code, 0);
  const Outcome merged = merge();
  ASSERT_EQ(merged.exit_code, 0) << merged.error;
  const Json first = merged.json();
  EXPECT_EQ(first["calibrations"][0]["rig"], "rig b") << first["calibrations"];
  ASSERT_GT(first["verdicts"].size(), 0U) << first["calibrations"];
  EXPECT_EQ(first["verdicts"][0]["name"], "CALIBRATION_SUSPECT");
  EXPECT_THAT(first["verdicts"][0]["text"].get<std::string>(), HasSubstr("of rig rig b"));

  // The calibration is put right: its sessions alone are solved again, and their change is what the report
  // shows.
  const fs::path right = work_ / "right";
  Result<Calibration> calibration = read_calibration(session(0) / "calibration");
  ASSERT_TRUE(calibration);
  calibration->subject.rig = "rig b";
  ASSERT_TRUE(write_calibration(right, *calibration));
  fs::rename(plan_file(), work_ / "first.jsonl");
  fs::rename(work_ / "night.results", work_ / "first.results");
  const Json planned = plan({"--calibration", right.string()});
  EXPECT_EQ(planned["sessions"], 2) << "those of the other rigs are there";
  ASSERT_EQ(run({"-q"}).exit_code, 0);
  const Json second = merge().json();
  ASSERT_EQ(second["changed"].size(), 2U);
  for (const Json& row : second["sessions"]) {
    EXPECT_GT(row["change"]["mean_deg"], 1.0) << "lights that were turned by 8 degrees";
    EXPECT_LT(row["change"]["left_out"]["after"], row["change"]["left_out"]["before"]);
    EXPECT_TRUE(row["regressions"].empty()) << row["regressions"];
  }
}

TEST_F(BatchTest, ACalibrationThatSuitsNoSessionIsRefused) {
  fill_archive(1);
  Result<Calibration> calibration = read_calibration(session(0) / "calibration");
  ASSERT_TRUE(calibration);
  calibration->subject.rig = "nobody's";
  ASSERT_TRUE(write_calibration(work_ / "other", *calibration));
  expect_refusal(work_,
                 {"batch", "plan", archive().string(), "-q", "--sample", "1", "--calibration",
                  (work_ / "other").string(), "-o", plan_file().string()},
                 65, {"calibration suits no session", "nobody's"});
}

}  // namespace
}  // namespace weft::test
