// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::bench {
namespace {

std::string marked(const std::string& inside) {
  return std::string("before\n") + kFiguresBegin + inside + kFiguresEnd + "\nafter\n";
}

TEST(AccuracyPage, ReplacesWhatStandsBetweenItsMarksAndNothingElse) {
  const auto once = with_figures(marked("\nold\n"), "new\n");
  ASSERT_TRUE(once.has_value()) << once.error().message();
  EXPECT_EQ(*once, marked("\n\nnew\n\n"));
  const auto twice = with_figures(*once, "new\n");
  ASSERT_TRUE(twice.has_value());
  EXPECT_EQ(*twice, *once);
}

TEST(AccuracyPage, IsRefusedWithoutItsMarks) {
  for (const std::string& page :
       {std::string("no marks"), std::string(kFiguresBegin), std::string(kFiguresEnd) + kFiguresBegin}) {
    const auto renewed = with_figures(page, "new");
    ASSERT_FALSE(renewed.has_value()) << page;
    EXPECT_EQ(renewed.error().kind, ErrorKind::kBadData);
  }
}

TEST(AccuracyPage, ShowsEachMethodOnceWithItsFigures) {
  const auto row = [](const char* scene, const char* method, double mean_deg, double ns) {
    return Json{
        {"scene", scene},         {"method", method}, {"mean_deg", mean_deg}, {"p95_deg", 2 * mean_deg},
        {"albedo_mean_rel", 0.1}, {"leak", 0.01},     {"ns_per_pixel", ns},   {"threads", 2}};
  };
  AccuracyFigures figures;
  figures.table = {row("deep white", "fast", 4.125, 10), row("deep white", "oracle", 3, 10),
                   row(kAllScenes, "fast", 4.25, 10), row(kAllScenes, "oracle", 3, 10)};
  const auto by_leds = [](int leds, double mean_deg, double ns) {
    return Json{{"leds", leds},
                {"numbers", "[5,7,9]"},
                {"method", "fast"},
                {"mean_deg", mean_deg},
                {"ns_per_pixel", ns}};
  };
  figures.leds = {by_leds(3, 9.5, 5), by_leds(10, 4.25, 11)};
  const std::string page = accuracy_markdown(figures);
  EXPECT_THAT(page, testing::HasSubstr("| deep white | 4.12 | 3 | 7.7 | 3.6 |")) << page;
  EXPECT_THAT(page, testing::HasSubstr("| 3 | [5,7,9] | fast | 9.5 |")) << page;
  const report::Plot plot = accuracy_plot(figures);
  ASSERT_EQ(plot.series.size(), 3U);
  ASSERT_EQ(plot.series[0].points.size(), 1U) << "the oracle has no price";
  EXPECT_EQ(plot.series[0].points[0].label, "fast");
  EXPECT_TRUE(plot.series[2].joined);
  ASSERT_EQ(plot.series[2].points.size(), 2U);
  EXPECT_EQ(plot.series[2].points[1].x, 10) << "the curve ends at the level's own mark";
}

}  // namespace
}  // namespace weft::bench
