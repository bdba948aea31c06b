// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "core/base/result.h"

namespace weft::capture {

struct LedBoardOptions {
  std::string port;       ///< any name that leads to it: "/dev/weft-led"
  double greeting_s = 4;  ///< how long it may take to say what it is, its bootloader's two seconds included
};

/// What last began the board anew.
enum class BoardReset { kUnknown, kPower, kExternal, kBrownOut, kWatchdog };
const char* name_of(BoardReset reset);  ///< "watchdog"

/// Why its lights last went off.
enum class WentDark { kNeverLit, kByCommand, kByTime, kBySilence };
const char* name_of(WentDark cause);  ///< "by its dead-man timer"

/// What a board says of itself when it is greeted.
struct BoardFacts {
  int protocol_major = 0, protocol_minor = 0;
  int firmware_major = 0, firmware_minor = 0;
  int leds = 0;
  BoardReset reset = BoardReset::kUnknown;  ///< what it last began from
  double dead_man_s = 0;                    ///< without a host, lights go off after this
  double longest_on_s = 0;                  ///< the longest a LED may be lit
  std::string usb;                          ///< "2341:0043 5573"; empty where it is no USB device
};

/// What a person should do about a board at this port whose firmware is older than this weft's; empty:
/// nothing.
std::string firmware_advice(const BoardFacts& facts, const std::string& port);

/// What it says at any moment.
struct BoardStatus {
  std::vector<int> lit;
  double uptime_s = 0;
  int bad_frames = 0;  ///< of requests; both counts begin again after 65 535
  int overruns = 0;
  WentDark dark = WentDark::kNeverLit;
  BoardReset reset = BoardReset::kUnknown;
};

/// The LED board on a serial port (docs/protocol.md). While a LED is lit a thread asks the board for its
/// status every 120 ms: that keeps its dead-man timer from ending the exposure, and lets it end it when this
/// process dies. Every call ends: within a second, but where recover() waits for a board that starts
/// (`greeting_s`).
///
/// A port that has gone is closed within a second, lit or not: for as long as it is open the kernel gives a
/// board that comes back another name. recover() finds a board with a USB serial number under any name.
///
/// Errors are those of capture/devices.h; light() also kUsage, for a LED that is not there or a time longer
/// than the board allows, and kTryAgain where the light that was lit before went out too soon: whatever was
/// photographed under it is to be taken again.
class LedBoard : public Lamps {
 public:
  /// Opens the port, resets the board and checks that it speaks this protocol.
  static Result<std::unique_ptr<LedBoard>> open(const LedBoardOptions& options);

  virtual BoardFacts facts() const = 0;
  virtual Result<BoardStatus> status() = 0;
};

}  // namespace weft::capture
