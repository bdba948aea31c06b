// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::capture {
namespace {

using testing::ElementsAre;

std::vector<std::string> stems(const std::vector<PlannedShot>& plan) {
  std::vector<std::string> names;
  for (const PlannedShot& shot : plan) names.push_back(file_stem(shot));
  return names;
}

TEST(Plan, BeginsAndEndsInTheDarkAndRepeatsTheFirstLed) {
  const auto plan = plan_shots({{1, 2, 3}, true, {}}, {20000, 100, 8}, {});
  EXPECT_THAT(stems(plan),
              ElementsAre("00_led00", "01_led01", "02_led02", "03_led03", "04_led01", "05_led00"));
  EXPECT_EQ(plan[4].role, ShotRole::kRepeat);
  EXPECT_EQ(plan.front().role, ShotRole::kDark);
  EXPECT_EQ(plan.back().role, ShotRole::kRepeat);
  for (const PlannedShot& shot : plan) EXPECT_EQ(shot.exposure, (ExposureSettings{20000, 100, 8}));
}

TEST(Plan, TakesBracketsAfterTheLedsAndAtTheirOwnTime) {
  const ShotList list = {{4, 2}, false, 4};
  const auto plan = plan_shots(list, {20000, 100, 8}, {80000, 0});
  EXPECT_THAT(stems(plan), ElementsAre("00_led00", "01_led04", "02_led02", "03_led04", "04_led02"));
  EXPECT_EQ(plan[4].role, ShotRole::kBracket);
  EXPECT_EQ(plan[4].exposure.exposure_us, 80000);
  EXPECT_EQ(list.count(), 5);
}

TEST(Plan, TakesOtherStatesOfThePolariserAndTheLightBelowBeforeTheLastDarkShot) {
  const ShotList list = {{1, 2}, true, {}, {Polariser::kCrossed, Polariser::kParallel}, true};
  const auto plan = plan_shots(list, {20000, 100, 8}, {0, 5000});
  EXPECT_THAT(stems(plan),
              ElementsAre("00_led00_crossed", "01_led01_crossed", "02_led02_crossed", "03_led01_crossed",
                          "04_led01_parallel", "05_led02_parallel", "06_below", "07_led00_crossed"));
  EXPECT_EQ(plan[4].role, ShotRole::kLit);
  EXPECT_EQ(plan[4].polariser, Polariser::kParallel);
  EXPECT_EQ(plan[6].role, ShotRole::kBelow);
  EXPECT_EQ(plan[6].exposure.exposure_us, 5000);
  EXPECT_EQ(list.count(), 8);
  EXPECT_EQ(to_json(list)["polariser"], Json({"crossed", "parallel"}));
}

TEST(Plan, FindsWhatASessionLacksInOrder) {
  const auto plan = plan_shots({{1, 2, 3}, true, {}}, {20000, 100, 8}, {});
  Session session;
  for (const int index : {0, 2, 4, 5}) session.shots.emplace_back().index = index;
  EXPECT_THAT(stems(missing_shots(plan, session)), ElementsAre("01_led01", "03_led03"));
}

TEST(Plan, TakesTheNearestShutterTimeByRatio) {
  EXPECT_EQ(nearest_time_us({1000, 2000, 4000}, 2700), 2000);
  EXPECT_EQ(nearest_time_us({1000, 2000, 4000}, 2900), 4000);
  EXPECT_EQ(nearest_time_us({}, 2900), 2900);
}

TEST(Plan, DoesNotTakeAShutterTimeForAnother) {
  const std::vector<double> times_us = {1000, 2000, 4000};
  EXPECT_EQ(settable_time_us(times_us, 2010).value(), 2000);
  const Result<double> between = settable_time_us(times_us, 2900);
  ASSERT_FALSE(between);
  EXPECT_EQ(between.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(between.error().why, "it has 2000 and 4000 us");
  EXPECT_EQ(settable_time_us(times_us, 1e8).error().why, "it has 1000 to 4000 us");
}

}  // namespace
}  // namespace weft::capture
