// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "virtual_rig/usb/wire.h"

namespace weft::virtual_rig::usb {

/// The host's end of a cable: one connection to a virtual camera's socket. Safe from several threads.
class Cable {
 public:
  explicit Cable(const std::string& socket);
  ~Cable();
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;

  bool connected() const { return fd_ >= 0; }
  int fd() const { return fd_; }

  struct Answer {
    UsbStatus status = UsbStatus::kDone;
    std::uint32_t length = 0;  ///< bytes of `in` that were filled
  };
  /// Nothing: the device is gone.
  std::optional<Answer> call(UsbCall call, std::span<const std::uint8_t> out, std::span<std::uint8_t> in,
                             std::uint32_t timeout_ms = 0, std::uint32_t value = 0);
  /// From now on the other end sends events by itself.
  bool listen();
  /// One of them; nothing: the device is gone.
  std::optional<Answer> event(std::span<std::uint8_t> in);

 private:
  bool write(std::span<const std::uint8_t> bytes) const;
  bool read(std::span<std::uint8_t> bytes) const;

  std::mutex mutex_;
  int fd_ = -1;
};

}  // namespace weft::virtual_rig::usb
