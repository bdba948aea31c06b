// SPDX-License-Identifier: Apache-2.0
#include "report/plot_svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace weft::report {
namespace {

using testing::HasSubstr;
using testing::Not;

Plot some_plot() {
  return {.title = "Error & time",
          .x_label = "ns",
          .y_label = "degrees",
          .series = {{"level", {{10, 4, "fast"}, {1000, 3, "standard"}, {100, 5, "slow and bad"}}},
                     {"by LEDs", {{12, 8, "3"}, {11, 6, "4"}}, true}},
          .frontier = true,
          .log_x = true,
          .log_y = true};
}

TEST(PlotSvg, FrontierIsWhatNothingBeatsInBoth) {
  std::vector<std::string> labels;
  for (const PlotPoint& p : frontier_of(some_plot().series)) labels.push_back(p.label);
  EXPECT_THAT(labels, testing::ElementsAre("fast", "standard"));
}

TEST(PlotSvg, OfEqualTimesOrErrorsOneIsOnTheFrontier) {
  const std::vector<PlotPoint> front = frontier_of({{"s", {{1, 2, "a"}, {1, 1, "b"}, {2, 1, "c"}}}});
  ASSERT_EQ(front.size(), 1U);
  EXPECT_EQ(front[0].label, "b");
}

TEST(PlotSvg, LabelsEveryMarkAndSaysTheSameTwice) {
  const std::string svg = plot_svg(some_plot());
  for (const char* label : {">fast<", ">standard<", ">slow and bad<", ">3<", ">4<", ">by LEDs<", "&amp;"}) {
    EXPECT_THAT(svg, HasSubstr(label));
  }
  EXPECT_EQ(svg, plot_svg(some_plot()));
}

TEST(PlotSvg, LeavesOutWhatALogarithmicAxisCannotShow) {
  Plot plot = some_plot();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  plot.series[0].points.push_back({0, 1, "no time"});
  plot.series[0].points.push_back({1, -1, "negative"});
  plot.series[1].points.push_back({nan, 1, "not a number"});
  EXPECT_EQ(plot_svg(plot), plot_svg(some_plot()));
}

TEST(PlotSvg, DrawsAnEmptyPlotAndASinglePoint) {
  for (const bool log : {false, true}) {
    for (const std::vector<PlotSeries>& series :
         {std::vector<PlotSeries>{}, std::vector<PlotSeries>{{"s", {{3, 7, "p"}}}}}) {
      const std::string svg = plot_svg({"t", "x", "y", series, true, log, log});
      EXPECT_THAT(svg, HasSubstr("</svg>"));
      EXPECT_THAT(svg, Not(HasSubstr("nan")));
      EXPECT_THAT(svg, Not(HasSubstr("inf")));
    }
  }
}

TEST(PlotSvg, ShowsValuesBelowZeroOnLinearAxes) {
  const std::string svg =
      plot_svg({.x_label = "x", .y_label = "y", .series = {{"s", {{-1, -1}, {0, 0}, {1, 1}}}}});
  EXPECT_THAT(svg, HasSubstr("<circle cx='402.0' cy='179.0' r='4.5'/>")) << "0 is in the middle of the field";
  EXPECT_THAT(svg, HasSubstr(">-1</text>"));
}

TEST(PlotSvg, IsFlatterWithoutATitle) {
  Plot plot = some_plot();
  EXPECT_THAT(plot_svg(plot), HasSubstr("viewBox='0 0 760 520'"));
  plot.title = "";
  EXPECT_THAT(plot_svg(plot), HasSubstr("viewBox='0 0 760 372'"));
}

TEST(PlotSvg, DrawsALineAloneWhereThereAreNoMarks) {
  const PlotSeries line = {.name = "fit", .points = {{1, 1}, {2, 2}}, .joined = true, .marked = false};
  const std::string svg = plot_svg({.x_label = "x", .y_label = "y", .series = {line}});
  EXPECT_THAT(svg, HasSubstr("<polyline"));
  EXPECT_THAT(svg, HasSubstr("x2='88.0' y2='22.0' stroke='#555'/>")) << "its legend is a piece of the line";
  EXPECT_THAT(svg, Not(HasSubstr("<circle")));
}

TEST(PlotSvg, TellsLinesApartByDashesWhereMarksComeRoundAgain) {
  Plot plot = {.x_label = "x", .y_label = "y"};
  for (int led = 1; led <= 10; ++led) {
    plot.series.push_back(
        {.name = "LED " + std::to_string(led), .points = {{0, 0}, {1, 1.0 * led}}, .joined = true});
  }
  const std::string svg = plot_svg(plot);
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray='6 3'"));
  EXPECT_THAT(svg, HasSubstr(">LED 10<"));
  plot.series.resize(5);
  EXPECT_THAT(plot_svg(plot), Not(HasSubstr("stroke-dasharray")));
}

TEST(PlotSvg, BreaksALegendThatIsTooLong) {
  Plot plot = {.x_label = "x", .y_label = "y"};
  const std::string name(40, 'n');
  for (int i = 0; i < 3; ++i) plot.series.push_back({.name = name});
  const std::string svg = plot_svg(plot);
  const std::string text = " text-anchor='start'>" + name;
  EXPECT_THAT(svg, HasSubstr("<text x='77.5' y='26.0'" + text));
  EXPECT_THAT(svg, HasSubstr("<text x='378.3' y='26.0'" + text)) << "40 letters of 6.72 and 32 of space on";
  EXPECT_THAT(svg, HasSubstr("<text x='77.5' y='44.0'" + text));
}

}  // namespace
}  // namespace weft::report
