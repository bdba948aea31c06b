// SPDX-License-Identifier: Apache-2.0
#include "report/hemisphere.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "report/preview.h"

namespace weft::report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string dot_at(const char* x, const char* y, double t) {
  return std::string("<circle cx=\"") + x + "\" cy=\"" + y + "\" r=\"7\" fill=\"" +
         css_colour(heat_colour(t)) + "\"/>";
}

TEST(Hemisphere, HasXToTheRightYUpAndTheHorizonAtItsEdge) {
  Hemisphere drawing = {"sky", "mm"};
  drawing.values = {{90, 0, 1}, {90, 90, 2}, {45, 180, 3}, {0, 0, 5}};
  const std::string svg = hemisphere_svg(drawing);
  EXPECT_THAT(svg, HasSubstr(dot_at("495.0", "285.0", 0)));
  EXPECT_THAT(svg, HasSubstr(dot_at("260.0", "50.0", 0.25)));
  EXPECT_THAT(svg, HasSubstr(dot_at("142.5", "285.0", 0.5)));
  EXPECT_THAT(svg, HasSubstr(dot_at("260.0", "285.0", 1)));
  EXPECT_THAT(svg, HasSubstr(">5 mm</text>"));
  EXPECT_EQ(svg, hemisphere_svg(drawing));
}

TEST(Hemisphere, NumbersItsLedsAndCirclesTheBest) {
  Hemisphere drawing = {"sky", "mm"};
  drawing.leds = {{30, 0, 0}, {30, 120, 0}};
  drawing.best = {60, 90, 0.125};
  const std::string svg = hemisphere_svg(drawing);
  EXPECT_THAT(svg, HasSubstr(">1</text>"));
  EXPECT_THAT(svg, HasSubstr(">2</text>"));
  EXPECT_THAT(svg, Not(HasSubstr(">3</text>")));
  EXPECT_THAT(svg, HasSubstr("cy=\"128.3\" r=\"13\""));
  EXPECT_THAT(svg, HasSubstr(">0.125</text>"));
}

TEST(Hemisphere, LeavesOutWhatIsUnknownAndEscapesItsWords) {
  Hemisphere drawing = {"<sky>", "<mm>"};
  drawing.values = {{10, 0, std::numeric_limits<double>::quiet_NaN()},
                    {20, 0, std::numeric_limits<double>::infinity()},
                    {30, 0, 4}};
  const std::string svg = hemisphere_svg(drawing);
  EXPECT_THAT(svg, HasSubstr("&lt;sky&gt;"));
  EXPECT_THAT(svg, HasSubstr("&lt;mm&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

}  // namespace
}  // namespace weft::report
