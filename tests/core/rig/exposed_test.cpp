// SPDX-License-Identifier: Apache-2.0
#include "core/rig/exposed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft {
namespace {

using testing::HasSubstr;

struct ExposedSession {
  Session session;

  void add(int led, Exposed exposed, ShotRole role = ShotRole::kLit) {
    Shot shot;
    shot.index = static_cast<int>(session.shots.size());
    shot.led = led;
    shot.role = role;
    shot.document = Json::object();
    set_exposed(exposed, shot.document);
    session.shots.push_back(shot);
  }
  void add_all(double clipped, double room) {
    for (int led = 1; led <= 10; ++led) add(led, {clipped, room});
  }
  std::string warning() const { return exposure_warning(session); }
};

TEST(Exposed, OfAScanThatWasMeteredWarnsOfNothing) {
  ExposedSession metered;
  metered.add_all(0, 1.1);
  metered.add(3, {0.4, 0.5}, ShotRole::kRepeat);
  EXPECT_EQ(metered.warning(), "");
  EXPECT_EQ(exposure_warning(Session()), "") << "a session of another program";
}

TEST(Exposed, SaysOnceThatAllLedsAreOver) {
  ExposedSession over;
  for (int led = 1; led <= 10; ++led) over.add(led, {0.88 + 0.012 * led, 0.1});
  EXPECT_EQ(
      over.warning(),
      "All 10 LEDs are over: 89 to 100 percent of a channel are full; scan again with a metered exposure");
}

TEST(Exposed, NamesTheLedsThatAreOverAndNotThoseWithAHighlight) {
  ExposedSession some;
  some.add_all(0.0002, 0.9);
  EXPECT_THAT(some.warning(), HasSubstr("All 10 LEDs have up to 0.02 percent of a channel full"));
  some.session.shots[2].document["exposed"]["clipped"] = 0.3;
  some.session.shots[6].document["exposed"]["clipped"] = 0.3;
  EXPECT_THAT(some.warning(), HasSubstr("LEDs 3 and 7 are over: 30 percent"));
}

TEST(Exposed, SaysThatAScanIsDarkFromTwoStopsOn) {
  ExposedSession dark;
  dark.add_all(0, 31);
  dark.session.shots[4].document["exposed"]["room"] = 3.9;
  EXPECT_EQ(dark.warning(), "") << "the brightest LED sets the exposure";
  dark.session.shots[4].document["exposed"]["room"] = 30.9;
  EXPECT_THAT(dark.warning(), HasSubstr("All 10 LEDs are dark: the exposure could be 31 times as long"));
}

TEST(Exposed, CountsTheBestOfALedsShots) {
  ExposedSession bracketed;
  bracketed.add_all(0.2, 0.2);
  for (int led = 1; led <= 10; ++led) bracketed.add(led, {0, 1}, ShotRole::kBracket);
  EXPECT_EQ(bracketed.warning(), "");
  ExposedSession again;
  again.add_all(0, 1);
  again.session.shots[0].document["exposed"]["clipped"] = 0.9;
  again.session.shots[0].superseded_by = 10;
  again.add(1, {0, 1});
  EXPECT_EQ(again.warning(), "");
}

}  // namespace
}  // namespace weft
