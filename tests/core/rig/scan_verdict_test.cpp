// SPDX-License-Identifier: Apache-2.0
#include "core/rig/scan_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace weft {
namespace {

using testing::ElementsAre;

Shot warned(int led, const std::string& warning) {
  Shot shot;
  shot.led = led;
  shot.document["warnings"] = {warning};
  return shot;
}

TEST(ScanVerdict, TellsACauseOnceAndNamesItsLeds) {
  Session session;
  session.shots = {warned(3, "LED 3 gives 72 percent of the light; look at it"),
                   warned(5, "the room is light"),
                   warned(7, "LED 7 gives 81.5 percent of the light; look at it"),
                   warned(4, "LED 4 gives 9 percent of the light; look at it")};
  EXPECT_THAT(warnings_of(session),
              ElementsAre("LED 3 gives 72 percent of the light, and LEDs 4, 7 likewise; look at it",
                          "the room is light"));
  const ScanVerdict verdict = verdict_of_photographs(session);
  EXPECT_EQ(verdict.says, "LED 3 gives 72 percent of the light, and LEDs 4, 7 likewise, and 1 more");
  EXPECT_EQ(verdict.action, "look at it");
}

TEST(ScanVerdict, ForgetsWhatWasTakenAgain) {
  Session session;
  session.shots = {warned(3, "LED 3 gives 72 percent of the light"),
                   warned(3, "LED 3 gives 71 percent of the light")};
  session.shots.front().superseded_by = 1;
  EXPECT_THAT(warnings_of(session), ElementsAre("LED 3 gives 71 percent of the light"));
}

}  // namespace
}  // namespace weft
