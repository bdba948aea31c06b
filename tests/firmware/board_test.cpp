// SPDX-License-Identifier: Apache-2.0
#include "firmware/board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/firmware/requests.h"

namespace weft {
namespace {

using test::BareBoard;
using test::Bytes;
using test::light_request;
using test::request;

Bytes payload_of(const Bytes& reply) {
  if (reply.size() < kWeftFrameHead + kWeftFrameCrc) return {};
  return {reply.begin() + kWeftFrameHead, reply.end() - kWeftFrameCrc};
}

/// The error code of a refusal; 0 for any other reply.
int error_in(const Bytes& reply) {
  return reply.size() > kWeftFrameHead && reply[3] == (kWeftError | kWeftReplyBit) ? reply[4] : 0;
}

TEST(BoardFirmware, GreetsWithItsVersionsAndLimits) {
  BareBoard board;
  board.board.reset_cause = kWeftResetWatchdog;
  EXPECT_THAT(
      payload_of(board.hear(request(1, kWeftHello))),
      testing::ElementsAre(kWeftProtocolMajor, kWeftProtocolMinor, kWeftFirmwareMajor, kWeftFirmwareMinor,
                           kWeftLeds, kWeftResetWatchdog, 0xF4, 0x01, 0xA0, 0x0F));
}

TEST(BoardFirmware, LightsOneLedAndSaysWhatWasLitBefore) {
  BareBoard board;
  for (int led = 0; led <= kWeftBelow; ++led) {
    const int before = board.lit();
    const Bytes said = payload_of(board.hear(light_request(led, led, 100)));
    ASSERT_EQ(said.size(), 2U) << led;
    EXPECT_EQ(weft_get_u16(said.data()), before) << led;
    EXPECT_EQ(board.lit(), led == 0 ? 0 : 1 << (led - 1));
  }
}

TEST(BoardFirmware, LightsTwoOnlyWhenAskedForAPair) {
  BareBoard board;
  board.hear(request(1, kWeftLightPair, {2, 9, 100, 0}));
  EXPECT_EQ(board.lit(), 1 << 1 | 1 << 8);
  board.hear(light_request(2, 5, 100));
  EXPECT_EQ(board.lit(), 1 << 4);
}

TEST(BoardFirmware, RefusesWhatItCannotDoAndChangesNothing) {
  BareBoard board;
  board.hear(light_request(1, 5, 100));
  int sequence = 2;
  const auto error_of = [&](int command, const Bytes& payload) {
    return error_in(board.hear(request(sequence++, command, payload)));
  };
  EXPECT_EQ(error_of(0, {}), kWeftUnknownCommand);
  EXPECT_EQ(error_of(7, {}), kWeftUnknownCommand);
  EXPECT_EQ(error_of(kWeftError, {}), kWeftUnknownCommand);
  EXPECT_EQ(error_of(kWeftLight, {3, 100}), kWeftWrongLength);
  EXPECT_EQ(error_of(kWeftHello, {0}), kWeftWrongLength);
  EXPECT_EQ(error_of(kWeftLight, {12, 100, 0}), kWeftNoSuchLed);
  EXPECT_EQ(error_of(kWeftLightPair, {3, kWeftBelow, 100, 0}), kWeftNoSuchLed);
  EXPECT_EQ(error_of(kWeftPolariser, {}), kWeftWrongLength);
  EXPECT_EQ(error_of(kWeftPolariser, {2}), kWeftWrongState);
  EXPECT_EQ(error_of(kWeftLightPair, {3, 3, 100, 0}), kWeftNoSuchLed);
  EXPECT_EQ(error_of(kWeftLightPair, {0, 3, 100, 0}), kWeftNoSuchLed);
  EXPECT_EQ(error_of(kWeftLight, {3, 0, 0}), kWeftWrongTime);
  EXPECT_EQ(error_of(kWeftLight, {3, 0xA1, 0x0F}), kWeftWrongTime);
  EXPECT_EQ(board.lit(), 1 << 4);
  EXPECT_EQ(board.board.polariser, kWeftParallel);
}

TEST(BoardFirmware, TurnsThePolariserAndSaysHowItStoodBefore) {
  BareBoard board;
  EXPECT_THAT(payload_of(board.hear(request(1, kWeftPolariser, {kWeftCrossed}))),
              testing::ElementsAre(kWeftParallel));
  EXPECT_EQ(board.board.polariser, kWeftCrossed);
  EXPECT_THAT(payload_of(board.hear(request(2, kWeftPolariser, {kWeftParallel}))),
              testing::ElementsAre(kWeftCrossed));
}

TEST(BoardFirmware, SaysHowLongEachLedWasLitLately) {
  BareBoard board;
  board.hear(light_request(1, 3, 100));
  board.wait_ms(401);
  board.hear(light_request(2, kWeftBelow, 10));
  board.wait_ms(100);
  const Bytes said = payload_of(board.hear(request(3, kWeftHeat)));
  ASSERT_EQ(said.size(), std::size_t{kWeftHeatReply});
  EXPECT_EQ(said[2], 2) << "401 ms lit, and about 100 ms dark: 301 ms";
  EXPECT_EQ(said[10], 1) << "100 ms";
  EXPECT_EQ(said[0], 0);
}

TEST(BoardFirmware, SaysHowLongALedMustRest) {
  BareBoard board;
  board.hear(light_request(1, 3, kWeftMostOn_cs));
  for (int ms = 0; ms < 10 * kWeftMostOn_cs; ms += 100) {
    board.wait_ms(100);
    board.hear(request(2 + ms / 100 % 2, kWeftStatus));
  }
  const Bytes said = board.hear(light_request(9, 3, 300));
  EXPECT_EQ(error_in(said), kWeftResting);
  EXPECT_EQ(weft_get_u16(&said[6]), 3000);
  EXPECT_EQ(board.lit(), 0);
}

TEST(BoardFirmware, RepeatsItsReplyToTheSameBytesWithoutActingAgain) {
  BareBoard board;
  const Bytes frame = light_request(9, 3, 10);
  const Bytes first = board.hear(frame);
  board.wait_ms(100);
  EXPECT_EQ(board.lit(), 0) << "its time is over";
  EXPECT_EQ(board.hear(frame), first);
  EXPECT_EQ(board.lit(), 0) << "lit once more";
  board.hear(light_request(10, 3, 10));
  EXPECT_EQ(board.lit(), 1 << 2) << "another number is another request";
}

TEST(BoardFirmware, ARepeatedRequestKeepsTheLightOn) {
  BareBoard board;
  const Bytes alive = request(2, kWeftStatus);
  board.hear(light_request(1, 3, 300));
  for (int i = 0; i < 5; ++i) {
    board.wait_ms(400);
    board.hear(alive);
    ASSERT_EQ(board.lit(), 1 << 2) << "after " << 400 * (i + 1) << " ms";
  }
}

TEST(BoardFirmware, ReportsWhatWentWrongSinceItsStart) {
  BareBoard board;
  board.board.overruns = 3;
  board.hear(light_request(1, 3, 100));
  board.wait_ms(kWeftDeadMan_ms);
  board.hear({kWeftRequestStart, 1, 2, 3, 4, 5, 6});
  const Bytes said = payload_of(board.hear(request(2, kWeftStatus)));
  ASSERT_EQ(said.size(), std::size_t{kWeftStatusReply});
  EXPECT_EQ(weft_get_u16(said.data()), 0) << "lit";
  EXPECT_EQ(weft_get_u32(&said[2]), kWeftDeadMan_ms) << "uptime";
  EXPECT_EQ(weft_get_u16(&said[6]), 1) << "bad frames";
  EXPECT_EQ(weft_get_u16(&said[8]), 3) << "overruns";
  EXPECT_EQ(said[10], kWeftDarkBySilence);
}

}  // namespace
}  // namespace weft
