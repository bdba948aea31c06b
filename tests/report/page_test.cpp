// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/html.h"

namespace weft::report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(HtmlPage, EscapesItsTitleAndTakesTheBodyAsItIs) {
  const std::string page = html_page("warp & <weft>", "<p>body</p>");
  EXPECT_THAT(page, HasSubstr("<title>warp &amp; &lt;weft&gt;</title>"));
  EXPECT_THAT(page, HasSubstr("<p>body</p>"));
}

TEST(HtmlPage, NeedsNoOtherFileAndNoScript) {
  const std::string page = html_page("t", "");
  for (const char* part : {"<script", "src=", "href=", "@import", "url("}) {
    EXPECT_THAT(page, Not(HasSubstr(part)));
  }
}

TEST(HtmlSection, BearsItsIdWhereItHasOne) {
  EXPECT_THAT(html_section("a < b", "x", "time"), HasSubstr("<section id=\"time\"><h2>a &lt; b</h2>"));
  EXPECT_THAT(html_section("a", "x"), HasSubstr("<section><h2>a</h2>"));
}

TEST(CssColour, RoundsToBytesAndHoldsToTheirRange) {
  EXPECT_EQ(css_colour({0, 0.5F, 1}), "#0080ff");
  EXPECT_EQ(css_colour({-1, 2, 1 / 255.0F}), "#00ff01");
}

TEST(Table, EscapesItsCellsAndDrawsAlarmsInRed) {
  const Table table = {
      .header = {"light", "gain <%>"}, .rows = {{"LED 1", "99"}, {"LED 2", "< 1"}}, .alarms = {1}};
  EXPECT_EQ(html_of(table),
            "<table>\n<tr><th>light</th><th class=\"n\">gain &lt;%&gt;</th></tr>\n"
            "<tr><td>LED 1</td><td class=\"n\">99</td></tr>\n"
            "<tr class=\"alarm\"><td>LED 2</td><td class=\"n\">&lt; 1</td></tr>\n</table>\n");
}

TEST(Table, WithoutAHeaderIsItsRows) {
  EXPECT_EQ(html_of(Table{.rows = {{"read"}}}), "<table>\n<tr><td>read</td></tr>\n</table>\n");
}

TEST(VerdictBox, SaysWhatIsWrongAndWhatToDoInSentences) {
  const std::string box = verdict_box(
      {{"LED_DEAD", "LED 3 looks dead & cold", "check its cable"}, {"X", "Done.", ""}}, "all well");
  EXPECT_EQ(box,
            "<div class=\"verdict alarm\">\n<p>LED 3 looks dead &amp; cold.</p>\n<p class=\"do\">Check its "
            "cable.</p>\n<p>Done.</p>\n</div>\n");
}

TEST(VerdictBox, WithoutVerdictsIsGood) {
  EXPECT_EQ(verdict_box({}, "all < well"), "<div class=\"verdict\">\n<p>all &lt; well</p>\n</div>\n");
}

TEST(Section, PutsFiguresSideBySideOnlyWhereThereAreTwo) {
  Section section = {.title = "Coverage", .paragraphs = {"5 < 6"}, .figures = {{"seen & counted", "<svg/>"}}};
  EXPECT_EQ(html_of(section),
            "<section><h2>Coverage</h2>\n<p>5 &lt; 6</p>\n<figure><svg/><figcaption>seen &amp; "
            "counted</figcaption></figure>\n</section>\n");
  section.figures.push_back({"predicted", "<svg/>"});
  EXPECT_THAT(html_of(section), HasSubstr("<div class=\"two\">\n<figure>"));
}

TEST(Page, SaysTheSummaryOnceAsVerdictOrUnderTheTitle) {
  Page page = {"Camera of <rig>", "15 boards", {}, {{.title = "Boards"}, {.title = "Numbers"}}};
  const std::string good = html_of(page);
  EXPECT_THAT(good, HasSubstr("<h1>Camera of &lt;rig&gt;</h1>\n<div class=\"verdict\">\n<p>15 boards.</p>"));
  EXPECT_EQ(count_of(good, "15 boards"), 1U);
  EXPECT_LT(good.find("<h2>Boards"), good.find("<h2>Numbers"));
  page.verdicts = {{"WEAK", "weak", "again"}};
  const std::string bad = html_of(page);
  EXPECT_THAT(bad, HasSubstr("<p class=\"meta\">15 boards.</p>\n<div class=\"verdict alarm\">"));
  EXPECT_EQ(count_of(bad, "15 boards"), 1U);
}

}  // namespace
}  // namespace weft::report
