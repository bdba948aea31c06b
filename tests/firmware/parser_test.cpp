// SPDX-License-Identifier: Apache-2.0
#include "firmware/parser.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/firmware/requests.h"

namespace weft {
namespace {

using test::Bytes;

/// How many whole frames a parser finds in bytes that come `pause_ms` apart.
int frames_in(WeftParser& parser, const Bytes& bytes, std::uint32_t& now_ms, std::uint32_t pause_ms = 0) {
  int frames = 0;
  for (const std::uint8_t byte : bytes) {
    now_ms += pause_ms;
    frames += weft_parser_take(&parser, byte, now_ms) ? 1 : 0;
  }
  return frames;
}

TEST(Crc, IsTheOneOfTheStandard) {
  const std::string text = "123456789";
  const Bytes bytes(text.begin(), text.end());
  EXPECT_EQ(weft_crc_of(bytes.data(), 9), 0x29B1);
}

TEST(RequestParser, FindsAFrameAndLeavesItInPlace) {
  WeftParser parser = {};
  std::uint32_t now_ms = 0;
  const Bytes frame = test::light_request(7, 3, 100);
  ASSERT_EQ(frames_in(parser, frame, now_ms), 1);
  EXPECT_EQ(Bytes(parser.bytes, parser.bytes + frame.size()), frame);
  EXPECT_EQ(parser.bad_frames, 0);
}

TEST(RequestParser, FindsEveryFrameOfAStream) {
  WeftParser parser = {};
  std::uint32_t now_ms = 0;
  int frames = 0;
  for (int i = 0; i < 600; ++i)
    frames += frames_in(parser, test::light_request(i & 0xFF, i % 11, 1 + i), now_ms);
  EXPECT_EQ(frames, 600);
}

TEST(RequestParser, FindsAFrameThatBeginsInsideABrokenOne) {
  WeftParser parser = {};
  std::uint32_t now_ms = 0;
  Bytes bytes = {kWeftRequestStart, 9, 1, 2};  // promises nine bytes that never come
  const Bytes whole = test::light_request(7, 3, 100);
  bytes.insert(bytes.end(), whole.begin(), whole.end());
  const Bytes next = test::request(8, kWeftStatus);
  bytes.insert(bytes.end(), next.begin(), next.end());
  EXPECT_EQ(frames_in(parser, bytes, now_ms), 2);
  EXPECT_EQ(parser.bad_frames, 1);
}

TEST(RequestParser, ForgetsAHalfFrameAfterTwentyMilliseconds) {
  const Bytes frame = test::light_request(7, 3, 100);
  const Bytes first(frame.begin(), frame.begin() + 5), second(frame.begin() + 5, frame.end());
  for (const std::uint32_t pause_ms : {20U, 21U}) {
    WeftParser parser = {};
    std::uint32_t now_ms = 1000;
    frames_in(parser, first, now_ms);
    now_ms += pause_ms;
    EXPECT_EQ(frames_in(parser, second, now_ms), pause_ms == 20 ? 1 : 0) << pause_ms;
    EXPECT_EQ(parser.bad_frames, pause_ms == 20 ? 0 : 1) << pause_ms;
    EXPECT_EQ(frames_in(parser, frame, now_ms), 1) << "the next frame is lost";
  }
}

TEST(RequestParser, RefusesALengthThatNoFrameHas) {
  WeftParser parser = {};
  std::uint32_t now_ms = 0;
  Bytes bytes = {kWeftRequestStart, kWeftMostPayload + 1, kWeftRequestStart, 255};
  const Bytes whole = test::request(8, kWeftStatus);
  bytes.insert(bytes.end(), whole.begin(), whole.end());
  EXPECT_EQ(frames_in(parser, bytes, now_ms), 1);
  EXPECT_EQ(parser.bad_frames, 2);
}

TEST(RequestParser, RefusesEveryFrameWithOneBitTurned) {
  const Bytes frame = test::light_request(7, 3, 100);
  for (std::size_t bit = 0; bit < frame.size() * 8; ++bit) {
    Bytes turned = frame;
    turned[bit / 8] = static_cast<std::uint8_t>(turned[bit / 8] ^ 1 << bit % 8);
    WeftParser parser = {};
    std::uint32_t now_ms = 0;
    EXPECT_EQ(frames_in(parser, turned, now_ms), 0) << "bit " << bit;
  }
}

// A whole frame by chance is one in four billion bytes, and it must be a light command besides.
TEST(RequestParser, NoiseNeverLightsALed) {
  test::BareBoard board;
  std::mt19937 random(1);
  Bytes noise(1'000'000);
  for (auto& byte : noise)
    byte = random() % 4 == 0 ? std::uint8_t{kWeftRequestStart} : static_cast<std::uint8_t>(random());
  for (const std::uint8_t byte : noise) {
    board.hear({byte});
    ASSERT_EQ(board.lit(), 0);
  }
  EXPECT_GT(board.parser.bad_frames, 0);
}

TEST(RequestParser, TheFrameAfterNoiseIsFoundAtOnceOrAfterAPause) {
  std::mt19937 random(2);
  int at_once = 0;
  for (int round = 0; round < 1000; ++round) {
    test::BareBoard board;
    Bytes noise(1 + random() % 40);
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
    board.hear(noise);
    at_once += board.hear(test::light_request(1, 3, 100)).empty() ? 0 : 1;
    board.wait_ms(kWeftParser_ms + 1);
    ASSERT_FALSE(board.hear(test::light_request(2, 4, 100)).empty()) << "round " << round;
    ASSERT_EQ(board.lit(), 1 << 3) << "round " << round;
  }
  EXPECT_GT(at_once, 950);
}

}  // namespace
}  // namespace weft
