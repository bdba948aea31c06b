// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/usb_serial.h"

#include <cstdio>
#include <fstream>
#include <system_error>

namespace weft::capture {
namespace {

/// The first word of a file, "" if it has none.
std::string word_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string word;
  in >> word;
  return word;
}

}  // namespace

std::string usb_serial_of(const std::string& port, const std::filesystem::path& devices) {
  int bus = 0, address = 0;
  if (std::sscanf(port.c_str(), "usb:%d,%d", &bus, &address) != 2) return "";
  std::error_code failed;
  for (const auto& device : std::filesystem::directory_iterator(devices, failed)) {
    if (word_in(device.path() / "busnum") == std::to_string(bus) &&
        word_in(device.path() / "devnum") == std::to_string(address))
      return word_in(device.path() / "serial");
  }
  return "";
}

}  // namespace weft::capture
