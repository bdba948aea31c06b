// SPDX-License-Identifier: Apache-2.0
#include "library/batch/choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace weft::library {
namespace {

using Sessions = std::vector<std::vector<LevelOption>>;

double seconds_of(const Sessions& sessions, const std::vector<std::size_t>& chosen) {
  double seconds = 0;
  for (std::size_t i = 0; i < sessions.size(); ++i) seconds += sessions[i][chosen[i]].seconds;
  return seconds;
}

double degrees_of(const Sessions& sessions, const std::vector<std::size_t>& chosen) {
  double degrees = 0;
  for (std::size_t i = 0; i < sessions.size(); ++i) degrees += sessions[i][chosen[i]].degrees;
  return degrees;
}

TEST(Spending, BuysWhereASecondIsWorthMost) {
  // The first gains 4 degrees in 10 s, the second 1 in 10 s.
  const Sessions sessions = {{{1, 5}, {11, 1}}, {{1, 2}, {11, 1}}};
  const Result<Spending> some = spend(sessions, 13), all = spend(sessions, 30), none = spend(sessions, 2.5);
  ASSERT_TRUE(some && all && none);
  EXPECT_THAT(some->chosen, testing::ElementsAre(1, 0));
  EXPECT_THAT(all->chosen, testing::ElementsAre(1, 1));
  EXPECT_THAT(none->chosen, testing::ElementsAre(0, 0));
}

TEST(Spending, PassesOverLevelsThatAreDearerAndWorse) {
  const Sessions sessions = {{{1, 5}, {5, 6}, {6, 1}, {60, 1}}};
  const Result<Spending> spending = spend(sessions, 1000);
  ASSERT_TRUE(spending);
  EXPECT_THAT(spending->chosen, testing::ElementsAre(2));
}

TEST(Spending, CountsASolveThatIsThereAsFree) {
  const Sessions sessions = {{{3, 5}, {0, 0.7}, {100, 0.6}}, {{3, 5}, {10, 0.7}, {100, 0.6}}};
  const Result<Spending> spending = spend(sessions, 20);
  ASSERT_TRUE(spending);
  EXPECT_THAT(spending->chosen, testing::ElementsAre(1, 1));
}

TEST(Spending, IsTheBestThatThereIsForWhatItSpends) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> cost(1, 50), error(0.2, 6);
  for (int round = 0; round < 200; ++round) {
    Sessions sessions(5);
    for (auto& options : sessions) {
      for (int l = 0; l < 4; ++l) options.push_back({cost(random), error(random)});
    }
    const Result<Spending> spending = spend(sessions, 110);
    if (!spending) continue;
    const double spent = seconds_of(sessions, spending->chosen), got = degrees_of(sessions, spending->chosen);
    ASSERT_LE(spent, 110);
    // All choices of five sessions, of those that cost no more.
    double best = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> chosen(5, 0);
    for (int code = 0; code < 1024; ++code) {
      for (std::size_t i = 0; i < 5; ++i) chosen[i] = static_cast<std::size_t>(code >> (2 * i) & 3);
      if (seconds_of(sessions, chosen) <= spent) best = std::min(best, degrees_of(sessions, chosen));
    }
    ASSERT_NEAR(got, best, 1e-12) << "round " << round;
  }
}

TEST(Spending, SaysWhatTheLeastIsWhereThereIsLess) {
  const Sessions sessions = {{{3600, 5}}, {{3600, 2}}};
  const Result<Spending> spending = spend(sessions, 100);
  ASSERT_FALSE(spending);
  EXPECT_EQ(spending.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(spending.error().message(), testing::HasSubstr("all 2 sessions takes 2 hours"));
}

TEST(Spending, HasACurveThatFallsFromTheCheapestToTheBest) {
  Sessions sessions;
  for (int i = 0; i < 100; ++i) sessions.push_back({{36, 5.0 + i}, {72, 1.0}, {360, 0.5}});
  const Result<Spending> spending = spend(sessions, 5000);
  ASSERT_TRUE(spending);
  const std::vector<Spent>& curve = spending->curve;
  EXPECT_NEAR(curve.front().hours, 1.0, 1e-9);
  EXPECT_NEAR(curve.front().mean_deg, 54.5, 1e-9);
  EXPECT_NEAR(curve.back().hours, 10.0, 1e-9);
  EXPECT_NEAR(curve.back().mean_deg, 0.5, 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(curve, {}, &Spent::hours));
  EXPECT_TRUE(std::ranges::is_sorted(curve, std::greater<>(), &Spent::mean_deg));
  EXPECT_LT(curve.size(), 16U);
}

TEST(CheapestWithin, IsTheCheapestThatIsCloseEnough) {
  const std::vector<LevelOption> options = {{1, 5}, {2, 0.7}, {3, 0.6}, {2.5, 0.5}};
  EXPECT_EQ(cheapest_within(options, 1), 1U);
  EXPECT_EQ(cheapest_within(options, 0.65), 3U);
  EXPECT_EQ(cheapest_within(options, 0.4), std::nullopt);
}

}  // namespace
}  // namespace weft::library
