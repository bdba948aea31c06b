// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/base/result.h"

namespace weft::virtual_rig {

/// What a virtual board and the terminal shim in the host's process share through a file: a pseudo-terminal
/// has no modem lines of its own.
struct ModemLines {
  std::atomic<std::uint64_t> terminal;   ///< st_rdev of the pseudo-terminal these are the lines of; 0: none
  std::atomic<std::uint32_t> lines;      ///< TIOCM_DTR and TIOCM_RTS as the host has set them
  std::atomic<std::uint32_t> exclusive;  ///< 1: the host wants nobody else to open it (TIOCEXCL)
  std::atomic<std::uint32_t> dtr_rises;  ///< times the host has raised DTR: an Arduino resets then
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// The environment variable that names the file to the shim, or several with a colon between two.
inline constexpr const char* kModemVariable = "WEFT_TERMINAL_MODEM";

using SharedModemLines = std::unique_ptr<ModemLines, void (*)(ModemLines*)>;

/// Makes the file, all zero.
Result<SharedModemLines> make_modem_lines(const std::filesystem::path& file);
/// Opens it where it is there; null if not.
SharedModemLines open_modem_lines(const std::filesystem::path& file);

}  // namespace weft::virtual_rig
