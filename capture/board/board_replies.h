// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "capture/board/led_board.h"
#include "capture/board/reply_parser.h"
#include "core/base/result.h"

namespace weft::capture {

/// What a reply to a light command says.
struct LightAnswer {
  std::uint16_t lit_before = 0;      ///< bit 0 is LED 1
  std::chrono::milliseconds rest{};  ///< above 0: refused, the LED must cool for so long
};

// Replies as facts. kProtocol where one is not what its command promises, with the error code it holds;
// facts_in() also kBadData for a board that speaks another version of the protocol.
Result<BoardFacts> facts_in(const BoardReply& hello, const std::string& port);
Result<LightAnswer> light_answer_in(const BoardReply& reply, const std::string& port);
Result<BoardStatus> status_in(const BoardReply& reply, const std::string& port);
/// Seconds that each LED was lit lately.
Result<std::vector<double>> heat_in(const BoardReply& reply, const std::string& port);
Result<void> polariser_answer_in(const BoardReply& reply, const std::string& port);

std::uint16_t mask_of(const std::vector<int>& leds);

}  // namespace weft::capture
