// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as what a LED board replies. Build it by the `fuzz` preset.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "capture/board/board_replies.h"
#include "capture/board/reply_parser.h"

namespace {

using namespace weft::capture;

void demand(bool promise) {
  if (!promise) std::abort();
}

void read(const BoardReply& reply) {
  demand(reply.length <= kWeftMostPayload);
  if (const auto facts = facts_in(reply, "port")) {
    demand(facts->leds >= 1 && facts->leds <= 16 && facts->protocol_major == kWeftProtocolMajor);
  } else {
    demand(!facts.error().what.empty() && !facts.error().remedy.empty());
  }
  if (const auto status = status_in(reply, "port")) demand(status->lit.size() <= 16 && status->uptime_s >= 0);
  if (const auto heat = heat_in(reply, "port")) {
    for (const double lately_s : *heat) demand(lately_s >= 0 && lately_s <= 51);
  }
  static_cast<void>(light_answer_in(reply, "port"));
  static_cast<void>(polariser_answer_in(reply, "port"));
}

/// The bytes as the payload of a whole frame, so that what replies mean is reached too.
void read_sealed(ReplyParser& parser, std::span<const std::uint8_t> bytes) {
  std::array<std::uint8_t, kWeftMostFrame> frame = {};
  const std::size_t length = std::min<std::size_t>(bytes.size() - 1, kWeftMostPayload);
  std::copy_n(bytes.begin() + 1, length, frame.begin() + kWeftFrameHead);
  const std::size_t size =
      weft_seal(frame.data(), kWeftReplyStart, 1, static_cast<std::uint8_t>(bytes[0] | kWeftReplyBit),
                static_cast<std::uint8_t>(length));
  bool found = false;
  for (std::size_t i = 0; i < size; ++i) {
    if (const auto reply = parser.take(frame[i])) {
      read(*reply);
      found = true;
    }
  }
  demand(found);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ReplyParser parser;
  if (size > 0) read_sealed(parser, {data, size});
  for (std::size_t i = 0; i < size; ++i) {
    if (const auto reply = parser.take(data[i])) read(*reply);
  }
  return 0;
}
