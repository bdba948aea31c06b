// SPDX-License-Identifier: Apache-2.0
// What befalls a board, its cable and its host, with the real libserialport and the real firmware in simavr.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <thread>

#include "capture/board/led_board.h"
#include "tests/capture/board/desk.h"

namespace weft::capture {
namespace {

using test::comes_true;
using test::Desk;
using test::light;
using test::LightHolder;
using virtual_rig::RigClock;
using virtual_rig::VirtualBoardFault;

/// The error of lights asked for in turn, until one is refused.
Error next_error(LedBoard& board) {
  Error error;
  comes_true(3, [&] {
    const auto lit = light(board, {4});
    if (!lit) error = lit.error();
    return !lit.has_value();
  });
  return error;
}

void expect_works(Desk& desk, LedBoard& board) {
  const auto lit = light(board, {6});
  ASSERT_TRUE(lit) << lit.error().message();
  EXPECT_EQ(desk.pins().now(), 1 << 5);
}

void expect_recovers(Desk& desk, LedBoard& board) {
  const auto found = board.recover();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(desk.pins().now(), 0) << "recovered, and not dark";
  expect_works(desk, board);
}

TEST(LedBoardHost, LeavesAllDarkWithin600MsWhenItIsKilled) {
  Desk desk;
  LightHolder host(desk.port(), 3);
  ASSERT_TRUE(desk.comes_to_light({3}, 10));
  const auto lit = RigClock::now();
  ASSERT_FALSE(comes_true(0.8, [&] { return desk.pins().now() != 4; })) << "went out with its host alive";
  host.kill();
  const auto killed = RigClock::now();
  const double still_s = desk.board().stood_still_s();
  ASSERT_TRUE(desk.comes_to_light({}, 3));
  EXPECT_GT(desk.lit_s_since(lit), 0.8);
  EXPECT_LE(desk.lit_s_since(killed), 0.6 + desk.board().stood_still_s() - still_s);
  EXPECT_NO_THROW(desk.open()) << "a dead process holds no port";
}

#ifndef WEFT_SANITIZED
TEST(LedBoardHost, WorksWithTheTerminalShimLoadedBeforeIt) {
  Desk desk;
  LightHolder host(desk.port(), 7, true);
  EXPECT_TRUE(desk.comes_to_light({7}, 10));
}
#endif

TEST(LedBoardFaults, AHungFirmwareIsDarkWithin300MsAndSaysThatItsWatchdogResetIt) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}));
  desk.inject(VirtualBoardFault::kHang);
  const auto hung = RigClock::now();
  const double still_s = desk.board().stood_still_s();
  ASSERT_TRUE(desk.comes_to_light({}, 2));
  EXPECT_LE(desk.lit_s_since(hung), 0.3 + desk.board().stood_still_s() - still_s);
  const Error error = next_error(*board);
  EXPECT_EQ(error.kind, ErrorKind::kTryAgain) << error.message();
  EXPECT_THAT(error.message(), testing::HasSubstr("reset (watchdog)"));
  const auto status = board->status();
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_EQ(status->reset, BoardReset::kWatchdog);
  expect_recovers(desk, *board);
}

TEST(LedBoardFaults, AResetInTheMiddleOfAnExposureIsNotMissed) {
  Desk desk("firmware", 0.01);
  const auto board = desk.open();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(light(*board, {3}));
    desk.inject(VirtualBoardFault::kReset);
    EXPECT_EQ(desk.pins().now(), 0);
    // At once, long before the keep-alive would see it.
    const auto lit = light(*board, {4});
    ASSERT_FALSE(lit) << "the exposure under LED 3 was cut short and nobody said so";
    EXPECT_EQ(lit.error().kind, ErrorKind::kTryAgain) << lit.error().message();
    EXPECT_THAT(lit.error().message(), testing::HasSubstr("went out before its time"));
    ASSERT_TRUE(desk.comes_to_light({}, 0.4));
    expect_recovers(desk, *board);
    ASSERT_TRUE(light(*board, {}));
  }
}

TEST(LedBoardFaults, TellsAPulledCableFromASlowReply) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}));
  desk.inject(VirtualBoardFault::kDeaf);
  const auto slow = light(*board, {4});
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.error().kind, ErrorKind::kTryAgain) << slow.error().message();
  desk.inject(VirtualBoardFault::kHear);
  expect_recovers(desk, *board);

  desk.inject(VirtualBoardFault::kUnplug);
  const Error gone = next_error(*board);
  EXPECT_EQ(gone.kind, ErrorKind::kNoDevice) << gone.message();
  const auto lost = board->recover();
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().kind, ErrorKind::kNoDevice) << lost.error().message();
  EXPECT_EQ(next_error(*board).kind, ErrorKind::kNoDevice);

  desk.inject(VirtualBoardFault::kReplug);
  expect_recovers(desk, *board);
}

TEST(LedBoardFaults, AReplyThatComesLateIsTakenAndActedOnOnce) {
  Desk desk;
  const auto board = desk.open();
  desk.inject(VirtualBoardFault::kSlow);
  for (int led = 1; led <= 5; ++led) {
    const auto lit = light(*board, {led});
    ASSERT_TRUE(lit) << lit.error().message();
    EXPECT_EQ(desk.pins().now(), 1 << (led - 1));
  }
  desk.inject(VirtualBoardFault::kHear);
  for (int led = 6; led <= 10; ++led) {
    const auto lit = light(*board, {led});
    ASSERT_TRUE(lit) << lit.error().message();
    EXPECT_EQ(desk.pins().now(), 1 << (led - 1)) << "a stale reply was taken";
  }
}

TEST(LedBoardFaults, ADeafMomentLosesNoCommand) {
  Desk desk;
  const auto board = desk.open();
  desk.inject(VirtualBoardFault::kDeaf);
  std::jthread mender([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    desk.inject(VirtualBoardFault::kHear);
  });
  const auto lit = light(*board, {4});
  ASSERT_TRUE(lit) << lit.error().message();
  EXPECT_EQ(desk.pins().now(), 1 << 3);
}

TEST(LedBoardFaults, NoiseOnTheCableLightsNothingAndPasses) {
  Desk desk;
  const auto board = desk.open();
  for (int i = 0; i < 5; ++i) {
    const auto begin = RigClock::now();
    desk.inject(VirtualBoardFault::kGarbage);
    std::this_thread::sleep_for(std::chrono::milliseconds(130));
    EXPECT_EQ(desk.lit_s_since(begin), 0);
    expect_works(desk, *board);
    ASSERT_TRUE(light(*board, {}));
    desk.inject(VirtualBoardFault::kGarbage);
    const auto lit = light(*board, {3});
    if (!lit) {
      EXPECT_EQ(lit.error().kind, ErrorKind::kTryAgain) << lit.error().message();
      expect_recovers(desk, *board);
    }
    ASSERT_TRUE(light(*board, {}));
  }
}

TEST(LedBoardFaults, AWrongSpeedIsSilenceAndEndsInDarkness) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}));
  desk.inject(VirtualBoardFault::kWrongBaud);
  ASSERT_TRUE(desk.comes_to_light({}, 1.5)) << "nobody it understands keeps it alight";
  const Error error = next_error(*board);
  EXPECT_EQ(error.kind, ErrorKind::kTryAgain) << error.message();
  desk.inject(VirtualBoardFault::kHear);
  expect_recovers(desk, *board);
}

TEST(LedBoardFaults, ABoardThatWasPulledAndPutBackBetweenTwoShotsIsNotTakenForTheSame) {
  Desk desk;
  const auto board = desk.open();
  ASSERT_TRUE(light(*board, {3}));
  desk.inject(VirtualBoardFault::kUnplug);
  desk.inject(VirtualBoardFault::kReplug);
  EXPECT_EQ(next_error(*board).kind, ErrorKind::kNoDevice);
  expect_recovers(desk, *board);
}

TEST(LedBoardFaults, TwentyFaultsInARowLeaveItWorking) {
  Desk desk("firmware", 0.01);
  const auto board = desk.open();
  constexpr std::array kFaults = {VirtualBoardFault::kReset, VirtualBoardFault::kReplug,
                                  VirtualBoardFault::kGarbage, VirtualBoardFault::kHang,
                                  VirtualBoardFault::kReset};
  const auto descriptors = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  };
  const auto open_before = descriptors();
  for (std::size_t i = 0; i < 20; ++i) {
    static_cast<void>(light(*board, {static_cast<int>(1 + i % 10)}));
    desk.inject(kFaults[i % kFaults.size()]);
    const bool again = comes_true(8, [&] { return board->recover().has_value(); });
    ASSERT_TRUE(again) << "fault " << i;
    expect_works(desk, *board);
  }
  EXPECT_EQ(descriptors(), open_before);
}

}  // namespace
}  // namespace weft::capture
