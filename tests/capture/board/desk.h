// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "capture/board/led_board.h"
#include "virtual_rig/board/virtual_board.h"

namespace weft::test {

/// A virtual board on a desk of its own, with a cable to this process and those it starts.
class Desk {
 public:
  /// `firmware`: "firmware", "firmware_older" or "firmware_newer".
  explicit Desk(const std::string& firmware = "firmware", double bootloader_s = 0.05)
      : Desk(firmware, bootloader_s, false) {}
  /// The board is a USB device, /dev/ttyACM0, for this process and those it starts.
  static Desk with_usb() { return Desk("firmware", 0.05, true); }
  ~Desk();
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  virtual_rig::VirtualBoard& board() { return *board_; }
  virtual_rig::LitLog& pins() { return pins_; }
  void inject(virtual_rig::VirtualBoardFault fault) { board_->inject(fault); }
  std::filesystem::path folder() const { return folder_; }
  std::filesystem::path terminal() const { return folder_ / "led"; }
  std::string port() const;
  capture::LedBoardOptions options() const { return {port(), 4}; }
  /// Opened, or an exception that says why not.
  std::unique_ptr<capture::LedBoard> open() const;

  /// Whether these LEDs and no other are lit, now or within `most_s`.
  bool comes_to_light(const std::vector<int>& leds, double most_s = 2) const;
  /// Seconds that any LED was lit from then until now.
  double lit_s_since(virtual_rig::RigClock::time_point then) const;

 private:
  Desk(const std::string& firmware, double bootloader_s, bool usb);

  std::filesystem::path folder_;
  virtual_rig::LitLog pins_;
  std::unique_ptr<virtual_rig::VirtualBoard> board_;
};

/// Lights these LEDs and no other, for at most `most_s`.
inline Result<double> light(capture::LedBoard& board, const std::vector<int>& leds, double most_s = 10) {
  return board.light(leds, most_s);
}

/// Whether it becomes true within `most_s`.
bool comes_true(double most_s, const std::function<bool()>& condition);

/// The program hold_light in a process of its own: it lights a LED and keeps it lit.
class LightHolder {
 public:
  LightHolder(const std::string& port, int led, bool preloaded = false);
  ~LightHolder();
  LightHolder(const LightHolder&) = delete;
  LightHolder& operator=(const LightHolder&) = delete;
  void kill();
  pid_t process() const { return process_; }

 private:
  pid_t process_ = -1;
};

}  // namespace weft::test
