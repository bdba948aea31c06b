// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/lamp_heat.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::app {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(LampHeat, RisesWhileALedIsLitAndFallsWhileItIsDark) {
  const LampHeat heat = {{10, 20, 30}, LampHeat::Time()};
  EXPECT_THAT(heat.can_light_s({2}, heat.felt), ElementsAre(10, 20, 30));
  EXPECT_THAT(heat.can_light_s({2}, heat.felt + seconds(4)), ElementsAre(14, 16, 34));
  EXPECT_THAT(heat.can_light_s({1, 3}, heat.felt + seconds(4)), ElementsAre(6, 24, 26));
}

TEST(LampHeat, LeavesNothingAtLeastAndWhatTheBoardAllowsAtMost) {
  const LampHeat heat = {{10, 20, 30}, LampHeat::Time()};
  EXPECT_THAT(heat.can_light_s({1}, heat.felt + seconds(15)), ElementsAre(0, 35, LampHeat::kMostLit_s));
}

TEST(LampHeat, IsNotToldWhereTheBoardCouldNotTell) {
  EXPECT_THAT(LampHeat().can_light_s({1}, LampHeat::Time() + seconds(1)), IsEmpty());
}

}  // namespace
}  // namespace weft::app
