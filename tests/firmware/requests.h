// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "firmware/board.h"
#include "firmware/parser.h"

namespace weft::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes request(int sequence, int command, const Bytes& payload = {}) {
  std::array<std::uint8_t, kWeftMostFrame> frame = {};
  std::ranges::copy(payload, frame.begin() + kWeftFrameHead);
  const std::uint8_t size =
      weft_seal(frame.data(), kWeftRequestStart, static_cast<std::uint8_t>(sequence),
                static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(payload.size()));
  return {frame.begin(), frame.begin() + size};
}

inline Bytes light_request(int sequence, int led, int on_cs) {
  return request(sequence, kWeftLight,
                 {static_cast<std::uint8_t>(led), static_cast<std::uint8_t>(on_cs & 0xFF),
                  static_cast<std::uint8_t>(on_cs >> 8)});
}

/// The firmware without its hardware, wired as main.c wires it.
struct BareBoard {
  WeftHeat heat = {};
  WeftBoard board = {};
  WeftParser parser = {};

  BareBoard() { weft_lamps_start(&board.lamps, &heat); }
  BareBoard(const BareBoard&) = delete;
  BareBoard& operator=(const BareBoard&) = delete;

  void wait_ms(int ms) {
    for (int i = 0; i < ms; ++i) weft_lamps_tick(&board.lamps);
  }
  /// All that it replies to these bytes.
  Bytes hear(const Bytes& bytes) {
    Bytes replies;
    for (const std::uint8_t byte : bytes) {
      if (!weft_parser_take(&parser, byte, board.lamps.uptime_ms)) continue;
      board.bad_frames = parser.bad_frames;
      const std::uint8_t size = weft_board_answer(&board, parser.bytes);
      replies.insert(replies.end(), board.reply, board.reply + size);
    }
    return replies;
  }
  int lit() const { return board.lamps.lit; }
};

}  // namespace weft::test
