// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/protocol/protocol.h"

namespace weft::capture {

/// A whole frame from a LED board.
struct BoardReply {
  std::uint8_t sequence = 0;
  std::uint8_t command = 0;  ///< that it answers, or kWeftError
  std::uint8_t length = 0;
  std::array<std::uint8_t, kWeftMostPayload> payload = {};
};

/// Finds replies in a stream of bytes that may hold anything.
class ReplyParser {
 public:
  /// Takes the next byte; gives the frame that it completes.
  std::optional<BoardReply> take(std::uint8_t byte);
  /// Forgets a frame that was begun.
  void forget() { count_ = 0; }

 private:
  void drop(std::uint8_t count);

  std::array<std::uint8_t, kWeftMostFrame> bytes_ = {};
  std::uint8_t count_ = 0;
};

}  // namespace weft::capture
