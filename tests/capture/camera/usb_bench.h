// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tests/capture/camera/link_bench.h"

namespace weft::capture {

/// A socket's path may have 107 characters, fewer than a test's folder.
inline std::string socket_path(const std::string& name) {
  return "/tmp/weft_usb_" + std::to_string(getpid()) + "_" + name;
}

class UsbBench : public LinkBench {
 public:
  explicit UsbBench(const std::string& name, const std::string& serial = "6000001")
      : LinkBench(options(name, serial)), socket_(socket_path(name)) {
    use_usb(socket_);
  }
  ~UsbBench() { std::filesystem::remove(socket_); }
  const std::string& socket() const { return socket_; }

 private:
  static virtual_rig::VirtualCameraOptions options(const std::string& name, const std::string& serial) {
    virtual_rig::VirtualCameraOptions options;
    options.serial = serial;
    options.usb = socket_path(name);
    options.away_s = 1.5;
    return with_finder(std::move(options));
  }
  std::string socket_;
};

}  // namespace weft::capture
