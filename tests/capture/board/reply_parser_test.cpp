// SPDX-License-Identifier: Apache-2.0
#include "capture/board/reply_parser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "capture/board/board_replies.h"

namespace weft::capture {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes reply(int sequence, int command, const Bytes& payload) {
  std::array<std::uint8_t, kWeftMostFrame> frame = {};
  std::ranges::copy(payload, frame.begin() + kWeftFrameHead);
  const std::size_t size = weft_seal(frame.data(), kWeftReplyStart, static_cast<std::uint8_t>(sequence),
                                     static_cast<std::uint8_t>(command | kWeftReplyBit),
                                     static_cast<std::uint8_t>(payload.size()));
  return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

std::vector<int> sequences_in(const Bytes& bytes) {
  ReplyParser parser;
  std::vector<int> found;
  for (const std::uint8_t byte : bytes) {
    if (const auto whole = parser.take(byte)) found.push_back(whole->sequence);
  }
  return found;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

BoardReply hello(const Bytes& payload) {
  BoardReply said;
  said.command = kWeftHello;
  said.length = static_cast<std::uint8_t>(payload.size());
  std::ranges::copy(payload, said.payload.begin());
  return said;
}

TEST(ReplyParser, ReadsAReply) {
  ReplyParser parser;
  const Bytes frame = reply(7, kWeftLight, {4, 0});
  for (std::size_t i = 0; i + 1 < frame.size(); ++i) ASSERT_FALSE(parser.take(frame[i])) << "byte " << i;
  const auto whole = parser.take(frame.back());
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->sequence, 7);
  EXPECT_EQ(whole->command, kWeftLight);
  EXPECT_EQ(whole->length, 2);
  EXPECT_EQ(whole->payload[0], 4);
}

TEST(ReplyParser, FindsRepliesBetweenNoiseAndHalfFrames) {
  const Bytes half = {kWeftReplyStart, 3, 9};
  EXPECT_THAT(sequences_in(joined({{1, 2, 3},
                                   reply(1, kWeftStatus, Bytes(12)),
                                   half,
                                   reply(2, kWeftLight, {0, 0}),
                                   {kWeftReplyStart, 200},
                                   reply(3, kWeftHello, Bytes(10))})),
              testing::ElementsAre(1, 2, 3));
}

TEST(ReplyParser, DoesNotTakeItsOwnRequestForAReply) {
  Bytes echo = reply(1, kWeftLight, {4, 0});
  weft_seal(echo.data(), kWeftReplyStart, 1, kWeftLight, 2);
  EXPECT_THAT(sequences_in(echo), testing::IsEmpty());
}

TEST(ReplyParser, MillionsOfRandomBytesDoNotUpsetIt) {
  ReplyParser parser;
  std::mt19937 random(1);
  int found = 0;
  for (int i = 0; i < 2'000'000; ++i) {
    const auto byte = random() % 4 == 0 ? std::uint8_t{kWeftReplyStart} : static_cast<std::uint8_t>(random());
    found += parser.take(byte) ? 1 : 0;
  }
  EXPECT_LT(found, 40) << "one in 65536 of what begins like a frame passes for one";
  const Bytes frame = reply(7, kWeftLight, {4, 0});
  int after = 0;
  for (int again = 0; again < 4; ++again)
    for (const std::uint8_t byte : frame) after += parser.take(byte) ? 1 : 0;
  EXPECT_GE(after, 2);
}

TEST(BoardReplies, AGreetingIsRead) {
  const auto facts = facts_in(hello({1, 0, 3, 4, 10, 8, 0xF4, 0x01, 0xA0, 0x0F}), "port");
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(facts->firmware_major, 3);
  EXPECT_EQ(facts->firmware_minor, 4);
  EXPECT_EQ(facts->leds, 10);
  EXPECT_EQ(facts->reset, BoardReset::kWatchdog);
  EXPECT_EQ(facts->dead_man_s, 0.5);
  EXPECT_EQ(facts->longest_on_s, 40);
}

TEST(BoardReplies, AnotherVersionIsNamedWhateverElseItSays) {
  const auto newer = facts_in(hello({2, 0}), "port");
  ASSERT_FALSE(newer);
  EXPECT_EQ(newer.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(newer.error().message(), testing::HasSubstr("newer than this weft"));
  const auto older = facts_in(hello({0, 9, 1, 0}), "port");
  ASSERT_FALSE(older);
  EXPECT_THAT(older.error().message(), testing::HasSubstr("weft rig flash port"));
}

TEST(BoardReplies, AShortOrForeignReplyIsAgainstTheProtocol) {
  for (const auto& reply : {hello({1}), hello({1, 0, 1, 0}), hello({1, 0, 1, 0, 0, 1, 0, 0, 0, 0})}) {
    const auto facts = facts_in(reply, "port");
    ASSERT_FALSE(facts);
    EXPECT_EQ(facts.error().kind, ErrorKind::kProtocol) << facts.error().message();
  }
  EXPECT_FALSE(status_in(hello(Bytes(12)), "port"));
  BoardReply refusal;
  refusal.command = kWeftError;
  refusal.length = kWeftErrorReply;
  refusal.payload = {kWeftNoSuchLed, kWeftLight};
  const auto answer = light_answer_in(refusal, "port");
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().message(), testing::HasSubstr("refused command 2 with code 3"));
}

}  // namespace
}  // namespace weft::capture
