// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/result.h"

namespace weft::virtual_rig {

/// What /dev and /sys of a machine hold of a terminal that is a USB device, as files in a folder:
/// /dev/ttyACM0, udev's link /dev/weft-led to it, and what libserialport reads below /sys. Goes with its
/// object.
class UsbTerminal {
 public:
  /// `machine`: the folder, shared by all devices of a machine. `number`: of ttyACM. `terminal`: leads to it.
  static Result<std::unique_ptr<UsbTerminal>> make(const std::filesystem::path& machine, int number,
                                                   const std::string& serial,
                                                   const std::filesystem::path& terminal);
  ~UsbTerminal();
  UsbTerminal(const UsbTerminal&) = delete;
  UsbTerminal& operator=(const UsbTerminal&) = delete;

 private:
  UsbTerminal() = default;

  std::filesystem::path device_, in_class_, by_number_, node_, udev_link_;
};

/// The environment variable that names the folder to the terminal shim. It then takes the place of all that
/// the machine itself has of USB terminals.
inline constexpr const char* kMachineVariable = "WEFT_TERMINAL_MACHINE";

}  // namespace weft::virtual_rig
