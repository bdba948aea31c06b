// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/base/result.h"

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

}  // namespace weft::virtual_rig
