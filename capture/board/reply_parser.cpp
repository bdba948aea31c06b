// SPDX-License-Identifier: Apache-2.0
#include "capture/board/reply_parser.h"

#include <algorithm>

namespace weft::capture {
namespace {

BoardReply reply_in(const std::uint8_t* frame) {
  BoardReply reply;
  reply.sequence = weft_sequence(frame);
  reply.command = static_cast<std::uint8_t>(weft_command(frame) & ~kWeftReplyBit);
  reply.length = weft_length(frame);
  std::copy_n(frame + kWeftFrameHead, reply.length, reply.payload.begin());
  return reply;
}

}  // namespace

void ReplyParser::drop(std::uint8_t count) {
  std::copy(bytes_.begin() + count, bytes_.begin() + count_, bytes_.begin());
  count_ = static_cast<std::uint8_t>(count_ - count);
}

std::optional<BoardReply> ReplyParser::take(std::uint8_t byte) {
  bytes_[count_++] = byte;
  for (;;) {
    const std::int8_t look = weft_look_at(bytes_.data(), count_, kWeftReplyStart);
    if (look == 0) return std::nullopt;
    if (look > 0 && (weft_command(bytes_.data()) & kWeftReplyBit) != 0) {
      const BoardReply reply = reply_in(bytes_.data());
      drop(static_cast<std::uint8_t>(look));
      return reply;
    }
    drop(1);
  }
}

}  // namespace weft::capture
