// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "capture/board/port_talk.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"

struct sp_port;

namespace weft::capture {

/// A serial port at 115200 baud, 8N1. While it is open no other weft opens it (a lock on the device, which
/// goes with the process), nor any other program (TIOCEXCL) but root's. Errors: kNoDevice where it is gone,
/// held by another program, or may not be opened; kTryAgain where it does not take what is written in time.
class SerialPort {
 public:
  /// `name` is any that leads to the device, links too.
  static Result<std::unique_ptr<SerialPort>> open(const std::string& name);
  /// What the kernel calls the ports that are this USB device.
  static std::vector<std::string> names_of_usb(const std::string& identity);
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// Lowers and raises DTR, which resets an Arduino, and throws away what was heard before.
  Result<void> pulse_dtr();
  Result<void> write(std::span<const std::uint8_t> bytes, std::chrono::milliseconds most);
  /// Reads what comes first; 0 bytes where nothing came in time and the port is still there.
  Result<std::size_t> read(std::span<std::uint8_t> bytes, std::chrono::milliseconds most);

  /// False once it has been pulled out.
  bool is_there() const;
  const std::string& name() const { return name_; }
  /// Which USB device it is, "2341:0043 5573"; empty where it is none.
  std::string usb_identity() const;
  UsbDevice usb() const;
  /// What the kernel calls the other ports that LED boards may be at by their USB numbers; none is opened.
  std::vector<std::string> other_boards() const;

 private:
  struct FreePort {
    void operator()(sp_port* port) const;
  };
  SerialPort(std::string name, Descriptor lock) : name_(std::move(name)), lock_(std::move(lock)) {}
  Result<void> set_up();
  Error gone() const;

  std::string name_;
  Descriptor lock_;
  std::unique_ptr<sp_port, FreePort> port_;
};

}  // namespace weft::capture
