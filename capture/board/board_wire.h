// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "capture/board/port_talk.h"
#include "capture/board/reply_parser.h"
#include "capture/board/serial_port.h"
#include "core/base/result.h"

namespace weft::capture {

/// Requests to a LED board and their replies. A request that gets no reply in 150 ms is sent again under its
/// sequence number, three times at most, so that the board does once what it is asked for once.
class BoardWire {
 public:
  explicit BoardWire(std::unique_ptr<SerialPort> port) : port_(std::move(port)) {}

  /// The reply, which may be kWeftError. Errors: kNoDevice (gone), PortTalk::no_board().
  Result<BoardReply> ask(std::uint8_t command, std::span<const std::uint8_t> payload = {});
  /// Resets the board by DTR and asks for its greeting until it answers or `most_s` have passed. A bootloader
  /// swallows what it hears, for up to two seconds. Where something else answers, it is listened to for a
  /// second more: does it talk of its own accord?
  Result<BoardReply> greet(double most_s);

  SerialPort& port() { return *port_; }
  /// What was heard instead of the last reply that did not come.
  const PortTalk& talk() const { return talk_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// Nothing where no reply came in time.
  Result<std::optional<BoardReply>> ask_until(Clock::time_point end, std::chrono::milliseconds each,
                                              std::uint8_t command, std::span<const std::uint8_t> payload);
  Result<void> listen_unasked();
  /// True and a reply, or false and none in time.
  Result<bool> listen(Clock::time_point end, std::uint8_t command, BoardReply& reply);

  std::unique_ptr<SerialPort> port_;
  ReplyParser parser_;
  PortTalk talk_;
  std::uint8_t sequence_ = 0;
};

}  // namespace weft::capture
