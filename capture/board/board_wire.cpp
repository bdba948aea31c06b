// SPDX-License-Identifier: Apache-2.0
#include "capture/board/board_wire.h"

#include <algorithm>
#include <array>
#include <utility>

namespace weft::capture {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPatience(150);  ///< a reply takes 2 ms, and 16 more in a slow USB bridge
constexpr int kTries = 4;
constexpr milliseconds kGreetingPatience(100);
constexpr milliseconds kUnasked(1100);  ///< a GPS receiver sends once a second

milliseconds until(std::chrono::steady_clock::time_point end) {
  return std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Result<BoardReply> BoardWire::ask(std::uint8_t command, std::span<const std::uint8_t> payload) {
  const auto begin = Clock::now();
  const auto reply = ask_until(begin + kTries * kPatience, kPatience, command, payload);
  if (!reply) return reply.error();
  if (*reply) return **reply;
  return talk_.no_board(port_->name(), port_->usb(), seconds_since(begin));
}

Result<BoardReply> BoardWire::greet(double most_s) {
  if (auto reset = port_->pulse_dtr(); !reset) return std::move(reset).error();
  const auto begin = Clock::now();
  const auto most = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(most_s));
  const auto reply = ask_until(begin + most, kGreetingPatience, kWeftHello, {});
  if (!reply) return reply.error();
  if (*reply) return **reply;
  if (!talk_.is_silent()) {
    if (auto heard = listen_unasked(); !heard) return std::move(heard).error();
  }
  return talk_.no_board(port_->name(), port_->usb(), seconds_since(begin));
}

Result<std::optional<BoardReply>> BoardWire::ask_until(Clock::time_point end, milliseconds each,
                                                       std::uint8_t command,
                                                       std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, kWeftMostFrame> frame = {};
  std::ranges::copy(payload, frame.begin() + kWeftFrameHead);
  const std::size_t size = weft_seal(frame.data(), kWeftRequestStart, ++sequence_, command,
                                     static_cast<std::uint8_t>(payload.size()));
  talk_.begin({frame.data(), size});
  while (Clock::now() < end) {
    parser_.forget();
    if (auto sent = port_->write({frame.data(), size}, each); !sent) return std::move(sent).error();
    BoardReply reply;
    const auto heard = listen(std::min(end, Clock::now() + each), command, reply);
    if (!heard) return heard.error();
    if (*heard) return std::optional(reply);
  }
  return std::optional<BoardReply>();
}

Result<bool> BoardWire::listen(Clock::time_point end, std::uint8_t command, BoardReply& reply) {
  while (Clock::now() < end) {
    std::array<std::uint8_t, 64> bytes = {};
    const auto count = port_->read(bytes, until(end));
    if (!count) return count.error();
    talk_.hear(std::span(bytes).first(*count), false);
    for (std::size_t i = 0; i < *count; ++i) {
      const auto found = parser_.take(bytes[i]);
      if (found) talk_.hear_reply();
      // A late reply to an earlier request bears another number.
      if (!found || found->sequence != sequence_) continue;
      if (found->command != command && found->command != kWeftError) continue;
      reply = *found;
      return true;
    }
  }
  return false;
}

Result<void> BoardWire::listen_unasked() {
  const auto answered = Clock::now() + kPatience, end = answered + kUnasked;
  while (Clock::now() < end) {
    std::array<std::uint8_t, 64> bytes = {};
    const auto count = port_->read(bytes, until(end));
    if (!count) return count.error();
    talk_.hear(std::span(bytes).first(*count), Clock::now() > answered);
  }
  return {};
}

}  // namespace weft::capture
