// SPDX-License-Identifier: Apache-2.0
#include "capture/board/board_wire.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace weft::capture {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPatience(150);  ///< a reply takes 2 ms, and 16 more in a slow USB bridge
constexpr int kTries = 4;
constexpr milliseconds kGreetingPatience(100);

milliseconds until(std::chrono::steady_clock::time_point end) {
  return std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
}

}  // namespace

Result<BoardReply> BoardWire::ask(std::uint8_t command, std::span<const std::uint8_t> payload) {
  return ask_until(Clock::now() + kTries * kPatience, kPatience, command, payload);
}

Result<BoardReply> BoardWire::greet(double most_s) {
  if (auto reset = port_->pulse_dtr(); !reset) return std::move(reset).error();
  const auto most = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(most_s));
  return ask_until(Clock::now() + most, kGreetingPatience, kWeftHello, {});
}

Result<BoardReply> BoardWire::ask_until(Clock::time_point end, milliseconds each, std::uint8_t command,
                                        std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, kWeftMostFrame> frame = {};
  std::ranges::copy(payload, frame.begin() + kWeftFrameHead);
  const std::size_t size = weft_seal(frame.data(), kWeftRequestStart, ++sequence_, command,
                                     static_cast<std::uint8_t>(payload.size()));
  const auto begin = Clock::now();
  while (Clock::now() < end) {
    parser_.forget();
    if (auto sent = port_->write({frame.data(), size}, each); !sent) return std::move(sent).error();
    BoardReply reply;
    const auto heard = listen(std::min(end, Clock::now() + each), command, reply);
    if (!heard) return heard.error();
    if (*heard) return reply;
  }
  const double waited_s = std::chrono::duration<double>(Clock::now() - begin).count();
  return Error{ErrorKind::kTryAgain, "the LED board does not answer", port_->name(),
               fmt::format("it is there and was silent for {:.1f} s", waited_s),
               "check that it is the LED board and flash its firmware: ./dev flash " + port_->name()};
}

Result<bool> BoardWire::listen(Clock::time_point end, std::uint8_t command, BoardReply& reply) {
  while (Clock::now() < end) {
    std::array<std::uint8_t, 64> bytes = {};
    const auto count = port_->read(bytes, until(end));
    if (!count) return count.error();
    for (std::size_t i = 0; i < *count; ++i) {
      const auto found = parser_.take(bytes[i]);
      // A late reply to an earlier request bears another number.
      if (!found || found->sequence != sequence_) continue;
      if (found->command != command && found->command != kWeftError) continue;
      reply = *found;
      return true;
    }
  }
  return false;
}

}  // namespace weft::capture
