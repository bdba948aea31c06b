// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace weft::report {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// The data within a page.
Json data_in(const std::string& page) {
  const std::size_t begin = page.find('{', page.find("id=\"report\""));
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

Json figure(decltype(Figure::drawing) drawing) {
  Page page = {.title = "t", .sections = {{.figures = {{"a label", std::move(drawing)}}}}};
  return data_in(html_of(std::move(page)))["sections"][0]["figures"][0];
}

TEST(Page, NeedsNoOtherFileAndCarriesWhatDrawsIt) {
  const std::string page = html_of({.title = "t"});
  EXPECT_THAT(page, HasSubstr(std::string(script())));
  for (const char* part : {"src=", "href=", "@import", "url("}) EXPECT_THAT(page, Not(HasSubstr(part)));
  EXPECT_EQ(page, html_of({.title = "t"}));
}

TEST(Page, TakesNoMarkupOfPeople) {
  const char* const hostile = "</script><script>alert(1)</script><!--";
  const Page page = {.title = hostile,
                     .meta = {hostile},
                     .summary = hostile,
                     .verdicts = {{"X", hostile, hostile}},
                     .sections = {{.title = hostile,
                                   .paragraphs = {hostile},
                                   .table = Table{{hostile}, {{hostile}}},
                                   .figures = {{hostile, Png{"Ma"}}},
                                   .note = hostile}}};
  const std::string html = html_of(page);
  EXPECT_THAT(html, AllOf(Not(HasSubstr("<script>alert")), Not(HasSubstr("<!--"))));
  EXPECT_EQ(data_in(html)["sections"][0]["table"]["rows"][0][0], hostile);
}

TEST(Page, SaysInSentencesWhatIsWrongAndWhatToDo) {
  const std::string html =
      html_of({.title = "Camera of <rig>",
               .summary = "15 boards",
               .verdicts = {{"LED_DEAD", "lED 3 looks dead & cold", "check its cable"}}});
  const Json data = data_in(html);
  EXPECT_EQ(data["summary"], "15 boards.");
  EXPECT_EQ(data["verdicts"][0]["text"], "LED 3 looks dead & cold.");
  EXPECT_EQ(data["verdicts"][0]["remedy"], "Check its cable.");
}

TEST(Page, SaysMostWithoutScripts) {
  const std::string html = html_of(
      {.title = "Camera of <rig>", .summary = "15 boards", .verdicts = {{"X", "weak & cold", "again"}}});
  const std::string without = html.substr(0, html.find("</main>"));
  for (const char* part : {"<title>Camera of &lt;rig&gt;</title>", "<h1>Camera of &lt;rig&gt;</h1>",
                           "15 boards.", "Weak &amp; cold. Again."})
    EXPECT_THAT(without, HasSubstr(part));
}

TEST(Table, TakesTheValuesOfAnyJson) {
  Table table;
  add_rows(table, Json::parse(R"({"a": {"b": 0.123456, "c": {"d": [1, "x", {"e": true}]}}, "f": 12345})"),
           {"step"});
  EXPECT_EQ(table.rows, (std::vector<std::vector<std::string>>{{"step", "a · b", "0.1235"},
                                                               {"step", "a · c · d", "1, x, {\"e\":true}"},
                                                               {"step", "f", "12345"}}));
}

TEST(Figure, IsAMapOfNumbersWithItsScale) {
  FrameMap map = {10, 10, {}, "deg"};
  for (int i = 0; i < 100; ++i) map.values.push_back(i + 1);
  EXPECT_NEAR(figure(map)["map"]["most"].get<double>(), 1.1 * 98, 1e-9) << "just over the 98th percentile";
  const Json data = figure(FrameMap{2, 1, {1, std::numeric_limits<double>::quiet_NaN()}, "mm", -1, 4})["map"];
  EXPECT_EQ(data["values"], Json({1.0, nullptr}));
  EXPECT_EQ(data["least"], -1);
  EXPECT_EQ(data["most"], 4);
}

TEST(Figure, IsArrowsADrawingOrAPicture) {
  const Json arrows = figure(Arrows{{640, 480}, {{320, 240, 2, -1}}, 10});
  EXPECT_EQ(arrows["arrows"]["all"], Json::parse("[[320, 240, 2, -1]]"));
  EXPECT_EQ(arrows["label"], "a label");
  EXPECT_EQ(figure(Svg("<svg/>"))["svg"], "<svg/>");
  // RFC 4648, section 10
  EXPECT_EQ(figure(Png{"f"})["png"], "Zg==");
  EXPECT_EQ(figure(Png{"fo"})["png"], "Zm8=");
  EXPECT_EQ(figure(Png{"foo"})["png"], "Zm9v");
}

}  // namespace
}  // namespace weft::report
