// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "virtual_rig/board/lit_log.h"

namespace weft::virtual_rig {

/// The USB device that a board is to its host (virtual_rig/terminal/usb_terminal.h).
struct VirtualUsb {
  std::filesystem::path machine;
  std::string serial = "5573";
};

/// What a virtual board is made of, and where its host finds it.
struct VirtualBoardOptions {
  std::filesystem::path firmware;      ///< the ELF that would be flashed
  std::filesystem::path terminal;      ///< a link to make to the pseudo-terminal: what the host opens
  std::filesystem::path modem;         ///< a file to make that the terminal shim shares its modem lines by
  double bootloader_s = 0.1;           ///< deaf after a reset
  std::optional<VirtualUsb> usb = {};  ///< none: a terminal and nothing more
};

/// What may befall a board.
enum class VirtualBoardFault {
  kUnplug,     ///< the terminal goes, as a pulled cable takes it; all dark (no power)
  kReplug,     ///< and comes back under the same link, the firmware from power-on
  kElsewhere,  ///< the same, but as the next ttyACM, as a board comes back whose terminal is still held open
  kReset,      ///< by its button
  kHang,       ///< the firmware's main loop stops; the watchdog is left to end it
  kGarbage,    ///< noise in both directions for 100 ms
  kDeaf,       ///< from now on nothing reaches it, until kHear
  kHear,
  kSlow,      ///< each reply 150 ms late, until kHear
  kWrongBaud  ///< what it hears is garbled, until kHear
};

/// The real firmware in simavr (GPL-3) in real time on a thread of its own, its UART on a pseudo-terminal,
/// its pins in a LitLog. A rise of DTR resets it, as on an Arduino.
class VirtualBoard {
 public:
  static Result<std::unique_ptr<VirtualBoard>> start(const VirtualBoardOptions& options, LitLog& pins);
  virtual ~VirtualBoard() = default;  ///< stops it; all dark
  virtual void inject(VirtualBoardFault fault) = 0;
};

}  // namespace weft::virtual_rig
