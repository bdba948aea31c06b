// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/un.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "core/base/result.h"
#include "virtual_rig/ptp/body.h"
#include "virtual_rig/ptp/link.h"
#include "virtual_rig/ptp/socket.h"
#include "virtual_rig/usb/wire.h"

namespace weft::virtual_rig::ptp {

/// PTP over USB (USB still image class): the containers of its bulk pipes, for the stand-in of libusb.
class UsbLink : public Link {
 public:
  /// The cable's socket. kCannotCreate.
  static Result<std::unique_ptr<UsbLink>> make(PtpBody& body, const std::filesystem::path& socket,
                                               std::uint16_t product);
  ~UsbLink() override;

  void hang_up() override {}  // a bus has no connection but its cable: set_present()
  void set_present(bool present) override;
  void announce(Event event, std::uint32_t parameter) override;

 private:
  /// A container on its way to the host, ended by a packet that is not full.
  struct Transfer {
    Bytes head = {};
    Payload payload = {};
    std::size_t sent = 0, most = 0;  ///< bytes of head and payload together; `most` less than all: a fault
    Delivery delivery = Delivery::kWhole;

    std::size_t left() const { return most - sent; }
  };
  struct Piece {
    usb::UsbStatus status = usb::UsbStatus::kDone;
    Bytes head = {};
    Payload payload = {};
    bool breaks = false;
  };
  struct Command {
    std::uint32_t transaction = 0;
    Request request;
  };

  UsbLink(PtpBody& body, std::filesystem::path path, const sockaddr_un& address, std::uint16_t product);
  void serve(int fd);
  bool answer(int fd, const usb::CallHead& call, BytesView data, bool& admitted);
  bool claim(int fd, bool& admitted);
  bool claimed_by(int fd);
  void clear();
  usb::UsbStatus take_out(BytesView bytes);
  void take_container(BytesView bytes);
  void send(const Command& command, const Answer& answer);
  Piece next_piece(int fd, std::size_t most, std::uint32_t timeout_ms);

  PtpBody& body_;
  const std::filesystem::path path_;
  const std::uint16_t product_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool present_ = false;
  std::uint8_t address_ = 6;
  int claimant_ = -1, events_fd_ = -1;
  Bytes out_;                       ///< of a container that is not whole yet
  std::optional<Command> command_;  ///< that waits for its data
  std::deque<Transfer> in_;
  Connections connections_;
  Acceptor acceptor_;  // last: ends first
};

}  // namespace weft::virtual_rig::ptp
