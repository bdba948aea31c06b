// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace weft::capture {

/// Which USB device a port is, as it says itself; empty where it is none.
struct UsbDevice {
  std::string numbers;  ///< "2341:0043"
  std::string serial;   ///< "5573"
  std::string name;     ///< "Arduino Uno"
};

/// Whether boards that the firmware runs on have these numbers: Arduino Uno, Nano, and Nanos with the bridges
/// CH340 and FT232. Such a bridge is in other devices too.
bool may_be_led_board(const UsbDevice& usb);

/// What a port was heard to say while nobody there answered as a LED board.
class PortTalk {
 public:
  static constexpr std::size_t kKept = 64;

  /// `sent`: the request, by which an echo is known.
  void begin(std::span<const std::uint8_t> sent);
  /// `unasked`: long after the last request.
  void hear(std::span<const std::uint8_t> bytes, bool unasked);
  void hear_reply() { ++replies_; }  ///< whole and valid, to another request

  bool is_silent() const { return bytes_ == 0; }
  /// Another device: it was understood, and is no LED board.
  bool is_foreign() const;

  /// In a sentence: kTryAgain where the port is silent or nothing can be read, kBadData for another device.
  /// Flashing is advised where the port is silent and may_be_led_board().
  Error no_board(const std::string& port, const UsbDevice& usb, double waited_s) const;

 private:
  std::string without_echo() const;

  std::string sent_, first_;  ///< bytes; `first_` at most kKept
  std::size_t bytes_ = 0, unasked_ = 0, replies_ = 0;
};

}  // namespace weft::capture
