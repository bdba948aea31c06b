// SPDX-License-Identifier: Apache-2.0
#include "report/plot_svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace weft::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

Plot some_plot() {
  return {"Error & time",
          "ns",
          "degrees",
          {{"level", {{10, 4, "fast"}, {1000, 3, "standard"}, {100, 5, "slow and bad"}}},
           {"by LEDs", {{12, 8, "3"}, {11, 6, "4"}}, true}},
          true};
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
  for (const Plot& plot :
       {Plot{"nothing", "x", "y", {}, true}, Plot{"one", "x", "y", {{"s", {{3, 7, "p"}}}}, true}}) {
    const std::string svg = plot_svg(plot);
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(PlotJson, HoldsEveryPoint) {
  const Json json = plot_json(some_plot());
  EXPECT_EQ(json["schema"], "weft.plot/1");
  EXPECT_EQ(json["series"][1]["points"][1]["y"], 6.0);
}

}  // namespace
}  // namespace weft::bench
