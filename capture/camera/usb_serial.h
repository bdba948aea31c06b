// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace weft::capture {

/// The serial number that the USB device at an address of libgphoto2 ("usb:001,007") has told the kernel,
/// read without opening the device. Empty where it told none. Of a Nikon it is the body's; other makers have
/// another number there, or none. `devices`: the kernel's list.
std::string usb_serial_of(const std::string& port,
                          const std::filesystem::path& devices = "/sys/bus/usb/devices");

}  // namespace weft::capture
