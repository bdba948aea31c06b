// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace weft::simulator {
namespace {

using testing::HasSubstr;

const std::vector<Rgb> kWhiteAndBlack = {{1, 1, 1}, {0, 0, 0}};

Pattern pattern_of(const PatternSettings& settings) {
  auto pattern = make_pattern(settings);
  EXPECT_TRUE(pattern) << pattern.error().message();
  if (pattern) return *std::move(pattern);
  return Pattern(std::vector<Rectangle>{{-1, -1, 1, 1, kWhiteInk}});
}

/// Share of white in a box.
double white(const Pattern& pattern, const TargetSpot& box) {
  return pattern.average(box, kWhiteAndBlack)[1];
}

double white_of_all(const Pattern& pattern) {
  return white(pattern, {0, 0, pattern.width_mm(), pattern.height_mm()});
}

TEST(Pattern, IsWhiteByTheShareOfItsWhiteArea) {
  // 10 x 7 squares of 15 mm, half of them black, in a sheet of 180 x 135 mm.
  const CheckerboardSettings board;
  const double black_share = 35 * 15.0 * 15.0 / (180 * 135);
  EXPECT_NEAR(white_of_all(pattern_of(board)), 1 - black_share, 1e-12);

  const ChartSettings chart;  // 24 patches that reflect nothing here, in a frame that does
  const Pattern pattern = pattern_of(chart);
  EXPECT_NEAR(pattern.width_mm(), 6 * 25 + 5 * 2.5 + 2 * 5, 1e-9);
  EXPECT_NEAR(pattern.height_mm(), 4 * 25 + 3 * 2.5 + 2 * 5, 1e-9);
  const std::vector<Rgb> frame_alone = {{0, 0, 0}, {1, 1, 1}};
  const double mean = pattern.average({0, 0, pattern.width_mm(), pattern.height_mm()}, frame_alone)[0];
  EXPECT_NEAR(mean, 1 - 24 * 625 / (pattern.width_mm() * pattern.height_mm()), 1e-12);
}

TEST(Pattern, TurnsFromBlackToWhiteLinearlyAcrossAnEdge) {
  const Pattern board = pattern_of(CheckerboardSettings{10, 8, 15, 0});
  // u = 0 is an edge, and the top row is above v = 45: column 5, right of the edge, is white there.
  for (const double shift : {-0.6, -0.5, -0.3, 0.0, 0.1, 0.5, 0.6}) {
    const double expected = std::clamp(0.5 + shift, 0.0, 1.0);
    EXPECT_NEAR(white(board, {shift * 0.8, 52, 0.8, 0.3}), expected, 1e-12) << "at " << shift << " widths";
  }
  EXPECT_NEAR(white(board, {0.2, 45 - 0.1, 0.8, 0.4}), 0.75 * 0.25 + 0.25 * 0.75, 1e-12) << "near a corner";
}

TEST(Pattern, MeanOverABoxIsTheMeanOverItsParts) {
  const Pattern board = pattern_of(CharucoSettings{});
  const TargetSpot box = {3.3, -7.1, 41.7, 23.9};
  double sum = 0;
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 9; ++i) {
      sum += white(board,
                   {box.u_mm + box.width_mm * ((i + 0.5) / 9 - 0.5),
                    box.v_mm + box.height_mm * ((j + 0.5) / 7 - 0.5), box.width_mm / 9, box.height_mm / 7});
    }
  }
  EXPECT_NEAR(white(board, box), sum / 63, 1e-12);
}

TEST(Pattern, CoversTheShareOfABoxThatLiesOnTheSheet) {
  const Pattern paper = pattern_of(PaperSettings{100, 50});
  EXPECT_EQ(paper.coverage({0, 0, 1, 1}), 1);
  EXPECT_NEAR(paper.coverage({50, 0, 1, 1}), 0.5, 1e-12);
  EXPECT_NEAR(paper.coverage({50.25, -25, 1, 1}), 0.125, 1e-12);
  EXPECT_EQ(paper.coverage({51, 0, 1, 1}), 0);
  EXPECT_NEAR(paper.coverage({0, 0, 200, 200}), 0.125, 1e-12);
  EXPECT_EQ(paper.coverage({49, 0, 0, 0}), 1);
  EXPECT_EQ(paper.coverage({51, 0, 0, 0}), 0);
  // What is beside the sheet does not darken its mean.
  EXPECT_NEAR(white(paper, {50, 0, 1, 1}), 1, 1e-12);
}

TEST(Pattern, PutsThePatchesOfAChartByRowsFromTheUpperLeft) {
  const Pattern chart = pattern_of(ChartSettings{});
  const double step = 27.5;
  for (int i = 0; i < 24; ++i) {
    const int row = i / 6;
    const double u = (i % 6 - 2.5) * step;
    const double v = (1.5 - row) * step;
    EXPECT_EQ(chart.ink_at(u, v), kFirstPatchInk + i);
    EXPECT_EQ(chart.ink_at(u + step / 2, v), kBlackInk) << "beside patch " << i + 1;
  }
}

TEST(Pattern, PutsTheStepsOfAGreyScaleFromLeftToRight) {
  const Pattern scale = pattern_of(GreyScaleSettings{{0.8, 0.4, 0.1}, 20, 2, 5});
  EXPECT_NEAR(scale.width_mm(), 3 * 20 + 2 * 2 + 2 * 5, 1e-12);
  EXPECT_EQ(scale.ink_at(-22, 0), kFirstPatchInk);
  EXPECT_EQ(scale.ink_at(0, 9), kFirstPatchInk + 1);
  EXPECT_EQ(scale.ink_at(22, -9), kFirstPatchInk + 2);
  EXPECT_EQ(scale.ink_at(11, 0), kWhiteInk);
}

TEST(Pattern, SurvivesSpotsThatAreNoPlaces) {
  const Pattern board = pattern_of(CheckerboardSettings{});
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const TargetSpot& spot : {TargetSpot{nan, 0, 1, 1}, TargetSpot{0, inf, 1, 1},
                                 TargetSpot{0, 0, inf, nan}, TargetSpot{0, 0, -1, 1e-300}}) {
    const double share = white(board, spot);
    EXPECT_TRUE(share >= 0 && share <= 1) << share;
    const double coverage = board.coverage(spot);
    EXPECT_TRUE(coverage >= 0 && coverage <= 1) << coverage;
  }
}

TEST(Pattern, NamesTheSettingThatIsOutOfItsRange) {
  struct Bad {
    PatternSettings settings;
    std::string where;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Bad& bad :
       {Bad{PaperSettings{nan, 1}, "width_mm"}, Bad{PaperSettings{1, 0}, "height_mm"},
        Bad{CheckerboardSettings{0, 7, 15, 15}, "squares_x"},
        Bad{CheckerboardSettings{10, 7, 15, -1}, "margin_mm"},
        Bad{CharucoSettings{7, 101, 20, 0.75, "DICT_5X5_100", 10}, "squares_y"},
        Bad{CharucoSettings{7, 5, 20, 1, "DICT_5X5_100", 10}, "marker_share"},
        Bad{CharucoSettings{7, 5, 20, 0.75, "DICT_5x5_100", 10}, "dictionary"},
        Bad{CharucoSettings{20, 11, 20, 0.75, "DICT_5X5_100", 10}, "dictionary"},
        Bad{GreyScaleSettings{{}, 20, 2, 5}, "number of reflectances"},
        Bad{ChartSettings{25, nan, 5}, "gap_mm"}, Bad{TagSettings{"DICT_4X4_50", 50, 15, 4}, "dictionary"},
        Bad{TagSettings{"DICT_4X4_50", -1, 15, 4}, "dictionary"}}) {
    const auto pattern = make_pattern(bad.settings);
    ASSERT_FALSE(pattern) << bad.where;
    EXPECT_EQ(pattern.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(pattern.error().where, bad.where) << pattern.error().message();
  }
  EXPECT_THAT(make_pattern(CharucoSettings{20, 11, 20, 0.75, "DICT_5X5_100", 10}).error().why,
              HasSubstr("ids 0 to 99, and 109"));
}

TEST(Pattern, HasADefaultOfEveryKind) {
  const std::pair<TargetKind, PatternSettings> defaults[] = {
      {TargetKind::kPaper, PaperSettings()},     {TargetKind::kCheckerboard, CheckerboardSettings()},
      {TargetKind::kCharuco, CharucoSettings()}, {TargetKind::kGreyScale, GreyScaleSettings()},
      {TargetKind::kChart, ChartSettings()},     {TargetKind::kTag, TagSettings()}};
  for (const auto& [kind, pattern] : defaults) {
    EXPECT_EQ(kind_of(pattern), kind);
    EXPECT_TRUE(make_pattern(pattern)) << pattern.index();
  }
}

}  // namespace
}  // namespace weft::simulator
