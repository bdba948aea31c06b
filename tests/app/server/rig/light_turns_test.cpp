// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/light_turns.h"

#include <gtest/gtest.h>

namespace weft::app {
namespace {

using std::chrono::milliseconds;

constexpr double kLeast_s = 1.5;

TEST(LightTurns, GoRoundWhereAllAreAsCool) {
  LightTurns turns(3);
  LightTurns::Time now;
  for (const int led : {1, 2, 3, 1, 2}) {
    EXPECT_EQ(turns.turn({40, 40, 40}, kLeast_s, now), led);
    EXPECT_EQ(turns.turn({40, 40, 40}, kLeast_s, now + LightTurns::kTurn - milliseconds(1)), led);
    now += LightTurns::kTurn;
  }
}

TEST(LightTurns, GoToTheCoolestOfTheOthers) {
  LightTurns turns(4);
  const LightTurns::Time now;
  EXPECT_EQ(turns.turn({10, 20, 30, 5}, kLeast_s, now), 3);
  EXPECT_EQ(turns.turn({10, 20, 40, 5}, kLeast_s, now + LightTurns::kTurn), 2);
}

TEST(LightTurns, EndBeforeALedIsTooWarm) {
  LightTurns turns(3);
  const LightTurns::Time now;
  EXPECT_EQ(turns.turn({9, 2, 2}, kLeast_s, now), 1);
  EXPECT_EQ(turns.turn({1.6, 2, 3}, kLeast_s, now + milliseconds(10)), 1);
  EXPECT_EQ(turns.turn({1.5, 2, 3}, kLeast_s, now + milliseconds(20)), 3);
}

TEST(LightTurns, PassOnWhereTheBoardCannotTell) {
  LightTurns turns(2);
  const LightTurns::Time now;
  for (const int led : {1, 2, 1}) EXPECT_EQ(turns.turn({}, kLeast_s, now), led);
}

}  // namespace
}  // namespace weft::app
