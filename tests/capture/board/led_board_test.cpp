// SPDX-License-Identifier: Apache-2.0
// The real libserialport and the real firmware in simavr.
#include "capture/board/led_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "tests/capture/board/desk.h"

namespace weft::capture {
namespace {

using test::Desk;
using test::light;
using virtual_rig::RigClock;

TEST(LedBoard, IsGreetedWithWhatItIs) {
  Desk desk;
  const auto board = desk.open();
  EXPECT_EQ(board->leds(), 10);
  const BoardFacts facts = board->facts();
  EXPECT_EQ(facts.protocol_major, 1);
  EXPECT_EQ(facts.reset, BoardReset::kExternal) << name_of(facts.reset);
  EXPECT_EQ(facts.dead_man_s, 0.5);
  EXPECT_EQ(facts.longest_on_s, 40);
}

TEST(LedBoard, WaitsForItsBootloader) {
  Desk desk("firmware", 1.2);
  const auto begin = RigClock::now();
  const auto board = desk.open();
  EXPECT_EQ(board->leds(), 10);
  EXPECT_GT(std::chrono::duration<double>(RigClock::now() - begin).count(), 1.2);
}

TEST(LedBoard, LightsEachLedByItsOwnPinAndNoOther) {
  Desk desk;
  const auto board = desk.open();
  for (int led = 1; led <= 10; ++led) {
    const auto lit = light(*board, {led});
    ASSERT_TRUE(lit) << lit.error().message();
    EXPECT_EQ(desk.pins().now(), 1 << (led - 1)) << "LED " << led;
  }
  ASSERT_TRUE(light(*board, {}));
  EXPECT_EQ(desk.pins().now(), 0);
}

TEST(LedBoard, NeverLightsTwoOnTheWayFromOneToTheNext) {
  Desk desk;
  const auto board = desk.open();
  const auto begin = RigClock::now();
  for (int led = 1; led <= 10; ++led) ASSERT_TRUE(light(*board, {led}));
  ASSERT_TRUE(light(*board, {}));
  const auto end = RigClock::now();
  EXPECT_LE(desk.lit_s_since(begin), std::chrono::duration<double>(end - begin).count());
}

TEST(LedBoard, LightsEveryPair) {
  Desk desk;
  const auto board = desk.open();
  for (int a = 1; a <= 10; ++a) {
    for (int b = 1; b <= 10; ++b) {
      if (a == b) continue;
      const auto lit = light(*board, {a, b});
      ASSERT_TRUE(lit) << lit.error().message();
      ASSERT_EQ(desk.pins().now(), 1 << (a - 1) | 1 << (b - 1)) << a << " and " << b;
    }
  }
}

TEST(LedBoard, RefusesALightThatTheBoardDoesNotHave) {
  Desk desk;
  const auto board = desk.open();
  for (const std::vector<int>& leds : {std::vector<int>{0}, {12}, {-1}, {3, 3}, {3, 11}, {1, 2, 3}}) {
    const auto lit = light(*board, leds);
    ASSERT_FALSE(lit);
    EXPECT_EQ(lit.error().kind, ErrorKind::kUsage) << lit.error().message();
  }
  for (const double most_s : {0.0, -1.0, 40.1, std::nan("")}) {
    const auto lit = light(*board, {3}, most_s);
    ASSERT_FALSE(lit);
    EXPECT_EQ(lit.error().kind, ErrorKind::kUsage) << lit.error().message();
  }
  EXPECT_EQ(desk.pins().now(), 0);
}

TEST(LedBoard, LightsTheLightBelowAndTurnsThePolariser) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(board->has_more_outputs());
  ASSERT_TRUE(board->polarise(Polariser::kCrossed));
  EXPECT_EQ(desk.pins().now(), 1 << virtual_rig::kPolariserBit);
  ASSERT_TRUE(light(*board, {11}));
  EXPECT_EQ(desk.pins().now(), 1 << virtual_rig::kPolariserBit | 1 << virtual_rig::kBelowBit);
  ASSERT_TRUE(light(*board, {3}));
  ASSERT_TRUE(board->polarise(Polariser::kParallel));
  EXPECT_EQ(desk.pins().now(), 1 << 2) << "the light stays as it is while the film turns";
  const auto refused = board->polarise(Polariser::kNone);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage) << refused.error().message();
}

TEST(LedBoard, SaysHowLongEachLedCanBeLit) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}, 2));
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  const auto seconds = board->can_light_s();
  ASSERT_TRUE(seconds) << seconds.error().message();
  ASSERT_EQ(seconds->size(), 11u);
  EXPECT_NEAR((*seconds)[2], 39, 0.25);
  EXPECT_EQ((*seconds)[10], 40);
}

TEST(LedBoard, IsParallelAfterItsStart) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(board->polarise(Polariser::kCrossed));
  ASSERT_TRUE(board->recover());
  EXPECT_EQ(desk.pins().now(), 0);
}

TEST(LedBoard, TurnsALightOffAfterItsTime) {
  Desk desk;
  const auto board = desk.open();
  const auto begin = RigClock::now();
  ASSERT_TRUE(light(*board, {3}, 0.3));
  ASSERT_TRUE(desk.comes_to_light({}));
  EXPECT_NEAR(desk.lit_s_since(begin), 0.3, 0.02);
  const auto status = board->status();
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_EQ(status->dark, WentDark::kByTime) << name_of(status->dark);
  EXPECT_TRUE(light(*board, {4})) << "a light that ended in time is no fault";
}

TEST(LedBoard, SaysForHowLongALedMustCoolAndLightsItThen) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}, 1));
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  const auto begin = RigClock::now();
  const auto cools_s = light(*board, {3}, 40);
  ASSERT_TRUE(cools_s) << cools_s.error().message();
  EXPECT_LT(std::chrono::duration<double>(RigClock::now() - begin).count(), *cools_s)
      << "it waited for that itself";
  EXPECT_EQ(desk.pins().now(), 0) << "it cools while it is dark";
  EXPECT_NEAR(*cools_s, desk.lit_s_since(RigClock::time_point()), 0.1) << "as long as it was lit";
  // The simulated board's time stands still where this machine has none for it, so it may ask for a little
  // more.
  double rest_s = *cools_s, rested_s = 0;
  while (rest_s > 0 && rested_s < 2) {
    std::this_thread::sleep_for(std::chrono::duration<double>(rest_s));
    rested_s += rest_s;
    const auto asked = light(*board, {3}, 40);
    ASSERT_TRUE(asked) << asked.error().message();
    rest_s = *asked;
  }
  EXPECT_EQ(rest_s, 0) << "after " << rested_s << " s of rest, where " << *cools_s << " s were said";
  EXPECT_EQ(desk.pins().now(), 1 << 2);
}

TEST(LedBoard, KeepsALightOnThroughALongExposure) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}, 10));
  const auto begin = RigClock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(1600));  // three times the dead-man timer
  const auto end = RigClock::now();
  EXPECT_TRUE(light(*board, {}));
  EXPECT_NEAR(desk.pins().lit_seconds(begin, end, 3)[2], std::chrono::duration<double>(end - begin).count(),
              1e-3);
}

TEST(LedBoard, SaysWhatItDoes) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {2, 9}));
  const auto status = board->status();
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_THAT(status->lit, testing::ElementsAre(2, 9));
  EXPECT_EQ(status->bad_frames, 0);
  EXPECT_EQ(status->overruns, 0);
  EXPECT_GT(status->uptime_s, 0);
  EXPECT_LT(status->uptime_s, 60);
}

TEST(LedBoard, LosesNoneOfAThousandCommands) {
  Desk desk;
  const auto board = desk.open();
  for (int i = 0; i < 1000; ++i) {
    const int led = 1 + i * 7 % 10;
    const auto lit = light(*board, {led});
    ASSERT_TRUE(lit) << i << ": " << lit.error().message();
    ASSERT_EQ(desk.pins().now(), 1 << (led - 1)) << i;
  }
  const auto status = board->status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->bad_frames, 0);
  EXPECT_EQ(status->overruns, 0);
}

TEST(LedBoard, LeavesAllDarkWhenItIsClosed) {
  Desk desk;
  auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}));
  board.reset();
  EXPECT_TRUE(desk.comes_to_light({}, 0.4)) << "that is sooner than the dead-man timer";
}

}  // namespace
}  // namespace weft::capture
