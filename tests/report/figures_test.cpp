// SPDX-License-Identifier: Apache-2.0
#include "report/figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "report/html.h"

namespace weft::report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string square(int x, int y, double t) {
  return "<rect x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) +
         "\" width=\"10.3\" height=\"10.3\" fill=\"" + css_colour(heat_colour(t)) + "\"/>";
}

TEST(FrameMap, DrawsItsValuesRowByRowInTheColoursOfItsScale) {
  const std::string svg = frame_map_svg({2, 2, {0, 1, 2, 4}, "mm", 0, 4});
  for (const std::string& each :
       {square(0, 0, 0), square(10, 0, 0.25), square(0, 10, 0.5), square(10, 10, 1)}) {
    EXPECT_THAT(svg, HasSubstr(each));
  }
  EXPECT_THAT(svg, HasSubstr(">0</text>"));
  EXPECT_THAT(svg, HasSubstr(">4 mm</text>"));
}

TEST(FrameMap, WithoutEndsGoesFromZeroToATenthOverThe98thPercentile) {
  FrameMap map = {101, 1, {}, "deg"};
  for (int i = 0; i <= 100; ++i) map.values.push_back(i);
  EXPECT_THAT(frame_map_svg(map), HasSubstr(">108 deg</text>")) << "1.1 x 98 in three digits";
}

TEST(FrameMap, LeavesWhatIsUnknownWhiteAndEscapesItsUnit) {
  const std::string svg = frame_map_svg({2, 1, {1, std::numeric_limits<double>::quiet_NaN()}, "<deg>"});
  EXPECT_THAT(svg, HasSubstr("<rect x=\"10\" y=\"0\" width=\"10.3\" height=\"10.3\" fill=\"#ffffff\"/>"));
  EXPECT_THAT(svg, HasSubstr("&lt;deg&gt;</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Arrows, AreAsManyAndAsLongAsAsked) {
  const Arrow arrow = {320, 100, 1, -2};
  const std::string svg = arrows_svg({640, 480}, {&arrow, 1}, 10);
  EXPECT_THAT(svg, HasSubstr("x1=\"320.0\" y1=\"100.0\" x2=\"330.0\" y2=\"80.0\""));
  EXPECT_THAT(svg, HasSubstr("10 times"));
}

TEST(Arrows, ShrinkWithTheFrame) {
  const Arrow arrow = {640, 200, 2, -4};
  EXPECT_THAT(arrows_svg({1280, 960}, {&arrow, 1}, 10),
              HasSubstr("x1=\"320.0\" y1=\"100.0\" x2=\"330.0\" y2=\"80.0\""));
}

}  // namespace
}  // namespace weft::report
