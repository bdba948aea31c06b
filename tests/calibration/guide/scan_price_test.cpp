// SPDX-License-Identifier: Apache-2.0
// What more shots buy of a scan, before one is taken.
#include "calibration/guide/scan_price.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "tests/core/places.h"
#include "tests/solver/light_plan/ten_leds.h"

namespace weft::calibration {
namespace {

using testing::HasSubstr;

constexpr ShotCost kCost = {.shot_s = 2, .exposure_s = 0.1, .bytes = 1e6};

ScanPriceOptions of_ten(const std::string& cloth = "cotton") {
  ScanPriceOptions options;
  options.asked.leds.resize(10);
  std::iota(options.asked.leds.begin(), options.asked.leds.end(), 1);
  options.cloth = *std::ranges::find(planned_cloths(), cloth, &NamedCloth::name);
  options.cost = kCost;
  return options;
}

std::vector<ShotsPrice> rows_of(const ScanPriceOptions& options) {
  const Result<ScanPrices> prices = price_scan(solver::ten_leds(), options);
  EXPECT_TRUE(prices) << prices.error().message();
  return prices ? prices->rows : std::vector<ShotsPrice>();
}

const ShotsPrice& only(const std::vector<ShotsPrice>& rows, bool ShotsPrice::*is) {
  EXPECT_EQ(std::ranges::count_if(rows, is), 1);
  return *std::ranges::find_if(rows, is);
}

double foretold_of(const ScanPriceOptions& options) {
  return only(rows_of(options), &ShotsPrice::is_asked).of_whole_deg().value();
}

TEST(ScanPrice, SellsNothingDearerThatIsNoBetter) {
  for (const char* cloth : {"cotton", "dark-satin"}) {
    const std::vector<ShotsPrice> rows = rows_of(of_ten(cloth));
    ASSERT_GT(rows.size(), 3u) << cloth;
    double best = 1e9;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_TRUE(i == 0 || *rows[i].seconds >= *rows[i - 1].seconds) << cloth << ": " << rows[i].what;
      EXPECT_TRUE(rows[i].is_asked || rows[i].of_whole_deg().value_or(1e8) < best)
          << cloth << ": " << rows[i].what;
      best = std::min(best, rows[i].of_whole_deg().value_or(1e8));
      EXPECT_EQ(*rows[i].bytes, 1e6 * rows[i].shots);
    }
    EXPECT_LE(only(rows, &ShotsPrice::is_chosen).of_whole_deg().value(), best * (1 + kNothingToGain))
        << cloth;
  }
}

TEST(ScanPrice, ForetellsNoLessByMoreShots) {
  for (const char* cloth : {"cotton", "dark-satin"}) {
    ScanPriceOptions options = of_ten(cloth);
    options.asked.repeat = false;
    const double bare = foretold_of(options);
    options.asked.repeat = true;
    const double repeated = foretold_of(options);
    options.asked.bracket = 16;
    const double bracketed = foretold_of(options);
    EXPECT_LT(repeated, bare) << cloth;
    EXPECT_LE(bracketed, repeated) << cloth;
    options.asked.leds.pop_back();
    EXPECT_GT(foretold_of(options), bracketed) << cloth;
  }
}

TEST(ScanPrice, TakesTheCheapestThatIsCloseEnough) {
  ScanPriceOptions options = of_ten();
  const std::vector<ShotsPrice> all = rows_of(options);
  for (const double to_deg : {3.0, 4.0, 6.0}) {
    options.wish.to_deg = to_deg;
    const auto first = std::ranges::find_if(
        all, [&](const ShotsPrice& row) { return row.of_whole_deg().value_or(1e9) <= to_deg; });
    ASSERT_NE(first, all.end()) << to_deg;
    EXPECT_EQ(only(rows_of(options), &ShotsPrice::is_chosen).what, first->what) << to_deg;
  }
}

TEST(ScanPrice, HasWhatFewerLedsWereMeasuredToCost) {
  const std::string page = read_text(in_sources("docs/measured/accuracy.md")).value();
  std::set<std::pair<std::size_t, double>> measured;
  const std::regex row(R"(\| (\d+) \| \[[0-9,]+\] \| standard \| ([0-9.]+) \|)");
  for (std::sregex_iterator match(page.begin(), page.end(), row), end; match != end; ++match)
    measured.emplace(std::stoul((*match)[1]), std::stod((*match)[2]));
  EXPECT_EQ(measured.size(), 8u);
  for (const ShotsPrice& each : rows_of(of_ten()))
    EXPECT_TRUE(measured.contains({each.list.leds.size(), each.cloth_deg})) << each.what;
}

TEST(ScanPrice, AdvisesARepeatThoughClothsOwnErrorsAreLarger) {
  EXPECT_TRUE(only(rows_of(of_ten()), &ShotsPrice::is_chosen).list.repeat);
}

TEST(ScanPrice, TakesNothingThatIsForetoldToTakeLonger) {
  ScanPriceOptions options = of_ten();
  double before = 1e9;
  for (const double seconds : {16.0, 20.0, 25.0, 30.0, 80.0}) {
    options.wish.within_s = seconds;
    const ShotsPrice chosen = only(rows_of(options), &ShotsPrice::is_chosen);
    EXPECT_LE(*chosen.seconds, seconds) << chosen.what;
    EXPECT_LE(*chosen.of_whole_deg(), before * (1 + kNothingToGain))
        << "more time, and worse: " << chosen.what;
    before = *chosen.of_whole_deg();
  }
}

TEST(ScanPrice, SaysTheBestWhereNothingIsCloseEnough) {
  ScanPriceOptions options = of_ten();
  options.wish = {.to_deg = 0.001, .within_s = 60};
  const Result<ScanPrices> prices = price_scan(solver::ten_leds(), options);
  ASSERT_FALSE(prices);
  EXPECT_EQ(prices.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(prices.error().message(), HasSubstr("the best, 10 LEDs, repeat"));
  options.wish.within_s.reset();
  options.cost.reset();
  EXPECT_THAT(price_scan(solver::ten_leds(), options).error().message(),
              HasSubstr("--to 0.001 degrees: the best, 10 LEDs, repeat has 2.85 degrees by 13 shots"))
      << "nobody knows their seconds";
}

TEST(ScanPrice, ForetellsNothingThatNobodyKnows) {
  ScanPriceOptions options = of_ten();
  options.cost.reset();
  const Result<ScanPrices> counted = price_scan({}, options);
  ASSERT_TRUE(counted);
  ASSERT_EQ(counted->rows.size(), 1u);
  EXPECT_EQ(counted->rows[0].shots, 13);
  EXPECT_FALSE(counted->rows[0].seconds || counted->rows[0].bytes || counted->rows[0].predicted_deg);
  EXPECT_EQ(counted->notes.size(), 2u);
  options.wish.within_s = 20;
  EXPECT_THAT(price_scan(solver::ten_leds(), options).error().message(), HasSubstr("scan one cloth first"));
}

TEST(ScanPrice, OffersNoBracketWhoseRatioNobodyMeasured) {
  ScanPriceOptions options = of_ten("dark-satin");
  const auto brackets = [&] {
    return std::ranges::count_if(rows_of(options),
                                 [](const ShotsPrice& row) { return row.list.bracket.has_value(); });
  };
  EXPECT_GT(brackets(), 0);
  options.may_bracket = false;
  EXPECT_EQ(brackets(), 0);
}

TEST(ScanPrice, KnowsWhatAShotTookWhereAScanWaitedOnce) {
  Session session;
  session.folder = testing::TempDir();
  for (int i = 0; i < 6; ++i) {
    Shot shot;
    shot.file = "shot";
    shot.exposure_us = 20000;
    shot.time = "2026-11-30T10:00:0" + std::to_string(i == 5 ? 9 : i) + "Z";
    session.shots.push_back(shot);
  }
  std::ofstream(session.folder / "shot") << "1234";
  const std::optional<ShotCost> cost = shot_cost_of(session);
  ASSERT_TRUE(cost);
  EXPECT_DOUBLE_EQ(cost->shot_s, 1);
  EXPECT_DOUBLE_EQ(cost->exposure_s, 0.02);
  EXPECT_DOUBLE_EQ(cost->bytes, 4);
}

}  // namespace
}  // namespace weft::calibration
