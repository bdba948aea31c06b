// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "tests/core/places.h"

namespace weft::bench {
namespace {

std::string marked(const char* begin, const std::string& part, const char* end) {
  return std::string("title\n") + begin + part + end + "\nafter\n";
}
std::string with_old_summary(const std::string& part) {
  return marked(kSummaryBegin, part, kSummaryEnd);
}
std::string with_old_figures(const std::string& part) {
  return marked(kFiguresBegin, part, kFiguresEnd);
}

// One scene by two levels and the oracle.
AccuracyFigures few_figures() {
  const auto row = [](const char* scene, const char* method, double mean_deg, double ns) {
    return Json{{"scene", scene},          {"method", method},       {"mean_deg", mean_deg},
                {"p95_deg", 2 * mean_deg}, {"albedo_mean_rel", 0.1}, {"leak", 0.01},
                {"ns_per_pixel", ns},      {"threads", 2},           {"left_out_rel", 0.04}};
  };
  const auto by_leds = [](int leds, double mean_deg, double ns) {
    return Json{{"leds", leds},
                {"numbers", "[5,7,9]"},
                {"method", "fast"},
                {"mean_deg", mean_deg},
                {"ns_per_pixel", ns}};
  };
  AccuracyFigures figures;
  figures.measured_by = {{"table", "solver version 4 on a processor, 2 threads"},
                         {"leds", "solver version 4 on a processor, 2 threads"}};
  figures.listing = "level  degrees\n";
  figures.table = {row("deep white", "fast", 4.125, 10), row("deep white", "oracle", 3, 10),
                   row(kAllScenes, "fast", 4.25, 10), row(kAllScenes, "oracle", 3, 10)};
  figures.leds = {by_leds(3, 9.5, 5), by_leds(10, 4.25, 11)};
  return figures;
}

TEST(AccuracyPage, ReplacesWhatStandsBetweenItsMarksAndNothingElse) {
  const auto once = with_figures(with_old_figures("\nold\n"), few_figures());
  ASSERT_TRUE(once.has_value()) << once.error().message();
  EXPECT_EQ(*once, with_old_figures("\n\n" + accuracy_markdown(few_figures()) + "\n"));
  const auto twice = with_figures(*once, few_figures());
  ASSERT_TRUE(twice.has_value());
  EXPECT_EQ(*twice, *once);
}

TEST(AccuracyPage, OfTheManualHasTheSummaryAlone) {
  const auto once = with_summary(with_old_summary("old"), few_figures());
  ASSERT_TRUE(once.has_value()) << once.error().message();
  EXPECT_EQ(*once, with_old_summary("\n\n" + summary_markdown(few_figures()) + "\n"));
  const auto twice = with_summary(*once, few_figures());
  ASSERT_TRUE(twice.has_value());
  EXPECT_EQ(*twice, *once);
}

TEST(AccuracyPage, IsRefusedWithoutItsMarks) {
  for (const std::string& page : {std::string("no marks"), std::string(kFiguresBegin),
                                  with_old_summary("old"), std::string(kFiguresEnd) + kFiguresBegin}) {
    const auto renewed = with_figures(page, few_figures());
    ASSERT_FALSE(renewed.has_value()) << page;
    EXPECT_EQ(renewed.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(renewed.error().where, kFiguresPage);
  }
  for (const std::string& page :
       {std::string(kSummaryBegin), with_old_figures("old"), std::string(kSummaryEnd) + kSummaryBegin}) {
    const auto renewed = with_summary(page, few_figures());
    ASSERT_FALSE(renewed.has_value()) << page;
    EXPECT_EQ(renewed.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(renewed.error().where, kSummaryPage);
  }
}

TEST(AccuracyPage, KeepsItsFiguresInAFileThatGivesThemBack) {
  const auto again = figures_from_json(json_of(few_figures()), "accuracy.json");
  ASSERT_TRUE(again.has_value()) << again.error().message();
  EXPECT_EQ(json_of(*again), json_of(few_figures()));
  EXPECT_EQ(figures_from_json(Json::object(), "accuracy.json").error().kind, ErrorKind::kBadData);
}

// Both pages are what their command made: nobody has changed a figure by hand or left a section out.
TEST(AccuracyPage, IsMadeOfTheFiguresBesideIt) {
  const std::filesystem::path docs = source_folder() / "docs";
  const auto figures = read_accuracy_docs(docs);
  ASSERT_TRUE(figures.has_value()) << figures.error().message();
  const std::pair<const char*, decltype(&with_summary)> pages[] = {{kSummaryPage, with_summary},
                                                                   {kFiguresPage, with_figures}};
  for (const auto& [name, renew] : pages) {
    const auto page = read_text(docs / name);
    ASSERT_TRUE(page.has_value()) << page.error().message();
    const auto made = renew(*page, *figures);
    ASSERT_TRUE(made.has_value()) << made.error().message();
    EXPECT_EQ(*made, *page) << name;
  }
  const std::pair<const char*, report::Plot> plots[] = {{"levels.svg", levels_plot(*figures)},
                                                        {"accuracy.svg", accuracy_plot(*figures)},
                                                        {"curves.svg", curves_plot(*figures)}};
  for (const auto& [name, plot] : plots) {
    const auto drawn = read_text(docs / "pictures" / name);
    ASSERT_TRUE(drawn.has_value()) << drawn.error().message();
    EXPECT_EQ(plot_svg(plot), *drawn) << name;
  }
}

TEST(AccuracyPage, IsWrittenWithTheManualOrNeitherIs) {
  const auto figures = read_accuracy_docs(source_folder() / "docs");
  ASSERT_TRUE(figures.has_value()) << figures.error().message();
  const TemporaryFolder scratch;
  const std::filesystem::path manual = scratch.path() / kSummaryPage, tables = scratch.path() / kFiguresPage;
  std::filesystem::create_directories(tables.parent_path());
  ASSERT_TRUE(write_file(manual, with_old_summary("old")).has_value());
  ASSERT_TRUE(write_file(tables, std::string("no marks")).has_value());
  const auto refused = write_accuracy_docs(scratch.path(), *figures);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().where, kFiguresPage);
  EXPECT_EQ(*read_text(manual), with_old_summary("old"));

  ASSERT_TRUE(write_file(tables, with_old_figures("old")).has_value());
  const auto written = write_accuracy_docs(scratch.path(), *figures);
  ASSERT_TRUE(written.has_value()) << written.error().message();
  EXPECT_EQ(*read_text(manual), with_old_summary("\n\n" + summary_markdown(*figures) + "\n"));
  EXPECT_EQ(*read_text(tables), with_old_figures("\n\n" + accuracy_markdown(*figures) + "\n"));
  const auto again = read_accuracy_docs(scratch.path());
  ASSERT_TRUE(again.has_value()) << again.error().message();
  EXPECT_EQ(json_of(*again), json_of(*figures));
}

TEST(AccuracyPage, ShowsEachMethodOnceWithItsFigures) {
  const AccuracyFigures figures = few_figures();
  const std::string page = accuracy_markdown(figures);
  EXPECT_THAT(page, testing::HasSubstr("| deep white | 4.12 | 3 |")) << page;
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
