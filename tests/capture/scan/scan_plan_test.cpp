// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/scan_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace weft::capture {
namespace {

using testing::ElementsAre;

std::vector<std::string> stems(const std::vector<DueShot>& plan) {
  std::vector<std::string> names;
  for (const DueShot& shot : plan) names.push_back(file_stem(shot));
  return names;
}

TEST(Plan, BeginsAndEndsInTheDarkAndRepeatsTheFirstLed) {
  const auto plan = plan_shots({{1, 2, 3}, true, {}}, {20000, 100, 8}, {});
  EXPECT_THAT(stems(plan),
              ElementsAre("00_led00", "01_led01", "02_led02", "03_led03", "04_led01", "05_led00"));
  EXPECT_EQ(plan[4].role, ShotRole::kRepeat);
  EXPECT_EQ(plan.front().role, ShotRole::kDark);
  EXPECT_EQ(plan.back().role, ShotRole::kRepeat);
  for (const DueShot& shot : plan) EXPECT_EQ(shot.exposure, (ExposureSettings{20000, 100, 8}));
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

TEST(Plan, TakesTheLedWithTheBladeAfterAllOthers) {
  const ShotList list = {
      .leds = {1, 2}, .repeat = true, .bracket = {}, .polariser = {}, .below = true, .blade = 2};
  const auto plan = plan_shots(list, {20000, 100, 8}, {0, 5000});
  EXPECT_THAT(stems(plan), ElementsAre("00_led00", "01_led01", "02_led02", "03_led01", "04_below", "05_led00",
                                       "06_led02_blade"));
  EXPECT_EQ(plan.back().role, ShotRole::kBlade);
  EXPECT_EQ(plan.back().exposure, (ExposureSettings{20000, 100, 8}));
  EXPECT_EQ(list.count(), 7);
  EXPECT_EQ(to_json(list)["blade"], 2);
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

TEST(Plan, TakesTheShutterTimeThatAPersonMeans) {
  const std::vector<double> times_us = {12500, 1e6 / 60, 1e6, 1.3e6, 1.6e6};
  for (const auto& [asked_us, means_us] : std::vector<std::pair<double, double>>{
           {16160, 1e6 / 60}, {14000, 12500}, {1.5e6, 1.6e6}, {11200, 12500}, {1.79e6, 1.6e6}}) {
    const Result<double> settable = settable_time_us(times_us, asked_us);
    ASSERT_TRUE(settable) << settable.error().message();
    EXPECT_EQ(*settable, means_us) << "for " << asked_us << " us";
  }
  EXPECT_EQ(nearest_time_words(16160, 1e6 / 60),
            "16.67 ms is the exposure that the camera has nearest to 16.16 ms");
  EXPECT_EQ(nearest_time_words(16700, 1e6 / 60), "") << "1/60 s is listed so";
  EXPECT_EQ(settable_time_us({}, 2900).value(), 2900) << "of a camera that lists none";
}

TEST(Plan, RefusesAShutterTimeBeyondAllThatTheCameraHas) {
  const std::vector<double> times_us = {250, 1000, 30e6};
  for (const auto& [asked_us, where] :
       std::vector<std::pair<double, std::string>>{{16.2, "16.2 us"}, {220, "220 us"}, {1e9, "1000 s"}}) {
    const Result<double> refused = settable_time_us(times_us, asked_us);
    ASSERT_FALSE(refused) << asked_us << " us became " << *refused;
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
    EXPECT_EQ(refused.error().where, where);
    EXPECT_EQ(refused.error().why, "it has 250 us to 30 s");
  }
}

}  // namespace
}  // namespace weft::capture
