// SPDX-License-Identifier: Apache-2.0
#include "solver/light_plan/best_place.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>
#include <vector>

#include "bench/oracles/oracle_rig.h"
#include "tests/solver/light_plan/ten_leds.h"

namespace weft::solver {
namespace {

LightPlan plan_of(const Lobe& lobe, double albedo, double relief_deg) {
  return {ten_leds(), {.lobe = lobe, .albedo = albedo, .relief_deg = relief_deg}};
}

TriedPlace found(const LightPlan& plan, LightAim aim) {
  const auto tried = try_places(plan, plan.as_it_is(), free_places(plan.rig()), {});
  EXPECT_TRUE(tried);
  const auto best = best_place(plan, plan.as_it_is(), *tried, aim, {});
  EXPECT_TRUE(best && *best);
  return **best;
}

TEST(BestPlace, IsBesideTheCameraForANarrowLobeOnLevelCloth) {
  const LightPlan plan = plan_of(ggx_of(0.1, 0.04), 0.3, 0);
  const TriedPlace best = found(plan, LightAim::kAlpha);
  EXPECT_LT(best.place.from_camera_deg, 12);
  const ForeseenSigma today = plan.sigma_of(plan.as_it_is());
  EXPECT_LT(best.sigma.alpha, today.alpha / 4) << "from " << today.alpha;
}

TEST(BestPlace, IsBeatenByNoOtherPlace) {
  test::Random random(5);
  const LightPlan plan = plan_of(ggx_of(0.3, 0.04), 0.1, 15);
  for (const LightAim aim : {LightAim::kAll, LightAim::kNormal, LightAim::kF0}) {
    const TriedPlace best = found(plan, aim);
    const double least = badness(best.sigma, plan.cloth().lobe, aim);
    for (int i = 0; i < 60; ++i) {
      const LedPlace place = {kNearestPlace_deg + (kFarthestPlace_deg - kNearestPlace_deg) * random.uniform(),
                              360 * random.uniform()};
      LightSet set = plan.as_it_is();
      set.added = led_at(plan.rig(), place);
      const double other = badness(plan.sigma_of(set), plan.cloth().lobe, aim);
      EXPECT_GT(other, least - 0.02) << kPlanAimNames[static_cast<std::size_t>(aim)] << " at "
                                     << place.from_camera_deg << ", " << place.azimuth_deg << ", not at "
                                     << best.place.from_camera_deg << ", " << best.place.azimuth_deg;
    }
  }
}

TEST(BestPlace, OfALedThatStandsTwiceInOnePlaceIsElsewhere) {
  ForeseenRig rig = ten_leds();
  rig.leds[3] = rig.leds[2];
  const LightPlan plan(rig, {.lobe = ggx_of(0.3, 0.04), .albedo = 0.1, .relief_deg = 15});
  const auto best = best_move(plan, free_places(rig), LightAim::kNormal, {});
  ASSERT_TRUE(best && *best);
  EXPECT_TRUE((*best)->moved == std::size_t{2} || (*best)->moved == std::size_t{3}) << *(*best)->moved;
  EXPECT_LT((*best)->sigma.normal_deg, plan.sigma_of(plan.as_it_is()).normal_deg);
}

TEST(BestPlace, StandsApartFromEveryLed) {
  const ForeseenRig rig = ten_leds();
  const std::vector<LedPlace> places = free_places(rig);
  EXPECT_GT(places.size(), 100U);
  for (const LedPlace place : places) {
    for (const NearLight& led : rig.leds)
      EXPECT_GE(angle_deg(led_at(rig, place).position_mm, led.position_mm), kApart_deg);
  }
}

TEST(BestPlace, IsNoneWhereNothingIsTold) {
  const LightPlan plan = plan_of({}, 0.5, 10);
  const auto tried = try_places(plan, plan.as_it_is(), free_places(plan.rig()), {});
  ASSERT_TRUE(tried);
  const auto best = best_place(plan, plan.as_it_is(), *tried, LightAim::kAlpha, {});
  ASSERT_TRUE(best);
  EXPECT_FALSE(*best) << "a matt cloth has no roughness";
}

TEST(BestPlace, StopsWhenItIsTold) {
  std::stop_source stop;
  stop.request_stop();
  const LightPlan plan = plan_of(ggx_of(0.3, 0.04), 0.1, 15);
  const auto best =
      best_move(plan, free_places(plan.rig()), LightAim::kAll, {.threads = 1, .stop = stop.get_token()});
  ASSERT_FALSE(best);
  EXPECT_EQ(best.error().kind, ErrorKind::kInterrupted);
}

TEST(BestPlace, IsTheSameForAnyNumberOfThreads) {
  const LightPlan plan = plan_of(ggx_of(0.3, 0.04), 0.1, 15);
  const std::vector<LedPlace> places = free_places(plan.rig());
  const auto one = try_places(plan, plan.as_it_is(), places, {.threads = 1});
  const auto three = try_places(plan, plan.as_it_is(), places, {.threads = 3});
  ASSERT_TRUE(one && three);
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ((*one)[i].sigma.normal_deg, (*three)[i].sigma.normal_deg) << i;
}

}  // namespace
}  // namespace weft::solver
