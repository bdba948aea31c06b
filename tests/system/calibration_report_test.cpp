// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibration_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::app {
namespace {

using testing::HasSubstr;
using testing::Not;

calibration::CalibrationReport small_report() {
  calibration::CalibrationReport report;
  report.part = "camera";
  report.title = "Camera of <rig>";
  report.summary = "15 boards, 0.08 px";
  report.sections = {{"Boards", {"One left out."}, report::Table{{"file", "rms"}, {{"a.dng", "0.1"}}}, {}}};
  report.numbers = {{"rms_px", 0.08}};
  return report;
}

TEST(CalibrationReport, IsAPageThatNeedsNoOtherFileAndItsTwin) {
  const std::vector<NamedFile> files = calibration::report_files(small_report());
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].name, "camera.html");
  EXPECT_THAT(files[0].bytes, HasSubstr("Camera of &lt;rig&gt;"));
  EXPECT_THAT(files[0].bytes, HasSubstr("[\"a.dng\",\"0.1\"]"));
  EXPECT_THAT(files[0].bytes, HasSubstr("15 boards, 0.08 px."));
  EXPECT_THAT(files[0].bytes, Not(HasSubstr("src=\"http")));
  EXPECT_EQ(files[1].name, "camera.json");
  const Json document = Json::parse(files[1].bytes);
  EXPECT_EQ(document["schema"], "weft.calibration-report/1");
  EXPECT_EQ(document["numbers"]["rms_px"], 0.08);
  EXPECT_TRUE(document["verdicts"].empty());
}

TEST(CalibrationReport, SaysFirstWhatIsWrongAndWhatToDo) {
  calibration::CalibrationReport report = small_report();
  report.verdicts = {{"MISFIT", "chi-square is 4.2", "lock nothing"}};
  const std::string page = calibration::report_files(report)[0].bytes;
  EXPECT_LT(page.find("Chi-square is 4.2."), page.find("One left out."));
  EXPECT_THAT(page, HasSubstr("Lock nothing."));
}

}  // namespace
}  // namespace weft::app
