// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "report/figures.h"

namespace weft::app {
namespace {

using testing::HasSubstr;
using testing::Not;

CalibrationReport small_report() {
  CalibrationReport report;
  report.part = "camera";
  report.title = "Camera of <rig>";
  report.summary = "15 boards, 0.08 px";
  report.sections = {{"Boards", {"One left out."}, ReportTable{{"file", "rms"}, {{"a.dng", "0.1"}}}, {}}};
  report.numbers = {{"rms_px", 0.08}};
  return report;
}

TEST(CalibrationReport, IsAPageThatNeedsNoOtherFileAndItsTwin) {
  const std::vector<NamedFile> files = report_files(small_report());
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].name, "camera.html");
  EXPECT_THAT(files[0].bytes, HasSubstr("Camera of &lt;rig&gt;"));
  EXPECT_THAT(files[0].bytes, HasSubstr("<td>a.dng</td>"));
  EXPECT_THAT(files[0].bytes, HasSubstr("15 boards, 0.08 px."));
  EXPECT_THAT(files[0].bytes, Not(HasSubstr("src=\"http")));
  EXPECT_EQ(files[1].name, "camera.json");
  const Json document = Json::parse(files[1].bytes);
  EXPECT_EQ(document["schema"], "weft.calibration-report/1");
  EXPECT_EQ(document["numbers"]["rms_px"], 0.08);
  EXPECT_TRUE(document["verdicts"].empty());
}

TEST(CalibrationReport, SaysFirstWhatIsWrongAndWhatToDo) {
  CalibrationReport report = small_report();
  report.verdicts = {{"MISFIT", "chi-square is 4.2", "lock nothing"}};
  const std::string page = report_files(report)[0].bytes;
  EXPECT_THAT(page, HasSubstr("verdict alarm"));
  EXPECT_LT(page.find("Chi-square is 4.2."), page.find("One left out."));
  EXPECT_THAT(page, HasSubstr("Lock nothing."));
}

TEST(FrameMap, ColoursEveryValueAndLeavesWhatIsUnknownWhite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = frame_map_svg({.columns = 2, .rows = 1, .values = {1, nan}, .unit = "deg"});
  EXPECT_THAT(svg, HasSubstr("fill=\"#ffffff\""));
  EXPECT_THAT(svg, HasSubstr("deg</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Lines, LeaveOutWhatALogarithmCannotShow) {
  const LinePlot plot = {"x", "y", {{"a", {1, 10, 100}, {0, 2, 30}}}, true, true};
  const std::string svg = lines_svg(plot);
  std::size_t marks = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
    ++marks;
  EXPECT_EQ(marks, 2U);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Lines, OfNothingAreAnEmptyPlot) {
  for (const LinePlot& plot : {LinePlot{"x", "y", {}}, LinePlot{"x", "y", {{"a", {3}, {5}}}}}) {
    const std::string svg = lines_svg(plot);
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
  }
}

TEST(Arrows, AreAsManyAndAsLongAsAsked) {
  const Arrow arrow = {320, 100, 1, -2};
  const std::string svg = arrows_svg({640, 480}, {&arrow, 1}, 10);
  EXPECT_THAT(svg, HasSubstr("x2=\"330.0\" y2=\"80.0\""));
  EXPECT_THAT(svg, HasSubstr("10 times"));
}

}  // namespace
}  // namespace weft::app
