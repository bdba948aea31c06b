// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "virtual_rig/board/lit_log.h"

namespace weft::virtual_rig {

/// The board's end of a pseudo-terminal, and a link to the host's end. Both go with it, as they do when a
/// cable is pulled.
class PseudoTerminal {
 public:
  /// `link` is made, replacing one that is there.
  static Result<std::unique_ptr<PseudoTerminal>> make(const std::filesystem::path& link);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  int descriptor() const { return board_end_; }
  dev_t device() const { return device_; }
  /// What the host has set its end to.
  bool is_at_115200_baud() const;
  /// What has come, 0 bytes if nothing. Never waits.
  std::size_t read(std::span<std::uint8_t> bytes) const;
  /// What does not fit is lost, as on a wire nobody listens to.
  void write(std::span<const std::uint8_t> bytes) const;

 private:
  PseudoTerminal(std::filesystem::path link, int board_end, int host_end, dev_t device)
      : link_(std::move(link)), board_end_(board_end), host_end_(host_end), device_(device) {}

  std::filesystem::path link_;
  int board_end_;
  int host_end_;  ///< held open: without a host the board's end would report a hang-up for ever
  dev_t device_;
};

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
  /// Seconds by which its time lies behind: it stands still where the machine is too busy to keep up.
  virtual double stood_still_s() const = 0;
};

}  // namespace weft::virtual_rig
