// SPDX-License-Identifier: Apache-2.0
#include "firmware/lamps.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace weft {
namespace {

constexpr std::uint16_t kMost_ms = 10 * kWeftMostOn_cs;

class Lamps : public testing::Test {
 protected:
  Lamps() { weft_lamps_start(&lamps_, &heat_); }
  /// With a host that is heard, or without one.
  void wait_ms(int ms, bool heard = true) {
    for (int i = 0; i < ms; ++i) {
      if (heard) weft_lamps_heard(&lamps_);
      weft_lamps_tick(&lamps_);
    }
  }
  WeftHeat heat_ = {};
  WeftLamps lamps_ = {};
};

TEST_F(Lamps, BeginDark) {
  EXPECT_EQ(lamps_.lit, 0);
  EXPECT_EQ(lamps_.dark_cause, kWeftNeverLit);
}

TEST_F(Lamps, GoOffAtTheEndOfTheirTime) {
  weft_lamps_light(&lamps_, 4, 1000);
  wait_ms(999);
  EXPECT_EQ(lamps_.lit, 4);
  wait_ms(1);
  EXPECT_EQ(lamps_.lit, 0);
  EXPECT_EQ(lamps_.dark_cause, kWeftDarkByTime);
}

TEST_F(Lamps, GoOffHalfASecondAfterTheHostWasLastHeard) {
  weft_lamps_heard(&lamps_);
  weft_lamps_light(&lamps_, 4, 10000);
  wait_ms(kWeftDeadMan_ms - 1, false);
  EXPECT_EQ(lamps_.lit, 4);
  wait_ms(1, false);
  EXPECT_EQ(lamps_.lit, 0);
  EXPECT_EQ(lamps_.dark_cause, kWeftDarkBySilence);
}

TEST_F(Lamps, GoOffByCommandWhenAnotherIsLit) {
  weft_lamps_light(&lamps_, 4, 1000);
  weft_lamps_light(&lamps_, 4, 1000);
  EXPECT_EQ(lamps_.dark_cause, kWeftNeverLit);
  weft_lamps_light(&lamps_, 8, 1000);
  EXPECT_EQ(lamps_.dark_cause, kWeftDarkByCommand);
}

TEST_F(Lamps, EachRestForAsLongAsTheyWereLitTooLong) {
  for (int led = 0; led < kWeftBelow; ++led) {
    weft_lamps_start(&lamps_, &heat_);
    const auto mask = static_cast<std::uint16_t>(1 << led),
               another = static_cast<std::uint16_t>(led == 0 ? 2 : 1);
    EXPECT_EQ(weft_lamps_rest_ms(&lamps_, mask, kMost_ms), 0);
    weft_lamps_light(&lamps_, mask, kMost_ms);
    wait_ms(kMost_ms);
    EXPECT_EQ(lamps_.lit, 0);
    EXPECT_EQ(weft_lamps_rest_ms(&lamps_, mask, 1000), 1000) << "bit " << led;
    EXPECT_EQ(weft_lamps_rest_ms(&lamps_, another, kMost_ms), 0) << "another LED has not been lit";
    EXPECT_EQ(weft_lamps_rest_ms(&lamps_, mask | another, kMost_ms), kMost_ms) << "a pair waits for both";
    wait_ms(1000 + 2 * 16);  // cooling comes in steps
    EXPECT_EQ(weft_lamps_rest_ms(&lamps_, mask, 1000), 0) << "bit " << led;
    wait_ms(kMost_ms);
  }
}

TEST_F(Lamps, ComeOutOfAResetAsHotAsTheyWentIn) {
  weft_lamps_light(&lamps_, 4, kMost_ms);
  wait_ms(30000);
  weft_lamps_start(&lamps_, &heat_);
  EXPECT_EQ(lamps_.lit, 0);
  EXPECT_EQ(weft_lamps_rest_ms(&lamps_, 4, 10001), 1);
}

TEST_F(Lamps, BeginColdFromMemoryThatHoldsChance) {
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    for (auto& mark : heat_.mark) mark = static_cast<std::uint16_t>(random());
    for (auto& ms : heat_.ms) ms = static_cast<std::uint16_t>(random());
    weft_lamps_start(&lamps_, &heat_);
    ASSERT_EQ(weft_lamps_rest_ms(&lamps_, 0x3FF, kMost_ms), 0);
  }
}

// Whatever a host asks for: never longer than the longest time at once, and half of the time in the long run.
TEST_F(Lamps, NoOrderOfCommandsLightsALedLonger) {
  std::mt19937 random(3);
  std::array<int, kWeftLeds> run_ms = {}, total_ms = {};
  const int hours_ms = 2 * 3600 * 1000;
  int next_ms = 0;
  for (int now = 0; now < hours_ms; ++now) {
    if (now >= next_ms) {
      const auto led = static_cast<int>(random() % 3);  // greedily the same few
      const auto on_ms = static_cast<std::uint16_t>(10 * (1 + random() % (random() % 2 != 0 ? 4000 : 50)));
      const auto mask = static_cast<std::uint16_t>(1 << led | (random() % 4 == 0 ? 8 : 0));
      if (weft_lamps_rest_ms(&lamps_, mask, on_ms) == 0) weft_lamps_light(&lamps_, mask, on_ms);
      next_ms = now + 1 + static_cast<int>(random() % 2000);
    }
    for (std::size_t led = 0; led < run_ms.size(); ++led) {
      const bool lit = (lamps_.lit >> led & 1) != 0;
      run_ms[led] = lit ? run_ms[led] + 1 : 0;
      total_ms[led] += lit ? 1 : 0;
      ASSERT_LE(run_ms[led], kMost_ms) << "LED " << led + 1 << " at " << now << " ms";
      ASSERT_LE(total_ms[led], now / 2 + kMost_ms) << "LED " << led + 1 << " at " << now << " ms";
    }
    wait_ms(1);
  }
  EXPECT_GT(total_ms[0], hours_ms / 10) << "the test lights too little to say anything";
}

TEST_F(Lamps, SwitchingInStepWithTheirClockDoesNotCoolThem) {
  const int minutes_ms = 20 * 60 * 1000;
  for (int off_ms = 1; off_ms < 16; ++off_ms) {
    heat_ = {};
    weft_lamps_start(&lamps_, &heat_);
    int lit_ms = 0;
    for (int now = 0; now < minutes_ms; ++now) {
      if (now % 16 == 0) weft_lamps_light(&lamps_, 0, 0);
      if (now % 16 == off_ms && weft_lamps_rest_ms(&lamps_, 1, 20) == 0) weft_lamps_light(&lamps_, 1, 20);
      lit_ms += lamps_.lit;
      wait_ms(1);
    }
    EXPECT_LE(lit_ms, minutes_ms / 2 + kMost_ms) << off_ms << " ms of 16 dark";
  }
}

}  // namespace
}  // namespace weft
