// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "core/base/result.h"
#include "virtual_rig/ptp/body.h"
#include "virtual_rig/ptp/bytes.h"
#include "virtual_rig/ptp/link.h"
#include "virtual_rig/ptp/socket.h"

namespace weft::virtual_rig::ptp {

/// PTP/IP (CIPA DC-005) as packets on streams, whatever carries these.

/// The kinds of packets, as the standard numbers them.
enum PacketType : std::uint32_t {
  kInitCommandRequest = 1,
  kInitCommandAck,
  kInitEventRequest,
  kInitEventAck,
  kInitFail,
  kOperationRequest,
  kOperationResponse,
  kEventPacket,
  kStartData,
  kData,
  kCancel,
  kEndData,
  kPing,
  kPong,
};

/// A packet without its length.
struct Packet {
  std::uint32_t type = 0;
  Bytes body;
};

/// Fills the bytes, or false: the stream has ended.
using ReadBytes = std::function<bool(std::span<std::uint8_t>)>;
/// Writes one part behind the other, or false.
using WriteBytes = std::function<bool(std::span<const BytesView>)>;

/// The next packet; nothing if the stream has ended or what comes is none: longer than 64 KiB, which nothing
/// is that a host sends to a camera, or shorter than its own head.
std::optional<Packet> read_packet(const ReadBytes& read);
bool write_packet(const WriteBytes& write, std::uint32_t type, BytesView body);

/// Serves operations until the stream ends or breaks its rules, or a fault of the body breaks it.
void serve_operations(const ReadBytes& read, const WriteBytes& write, PtpBody& body);

/// PTP/IP on 127.0.0.1: one host at a time, operations and events on a connection each.
class NetworkLink : public Link {
 public:
  /// Keeps the port from now on, free or not free to connect to. 0: any. kTryAgain if another program has it.
  static Result<std::unique_ptr<NetworkLink>> make(PtpBody& body, std::uint16_t port);

  std::uint16_t port() const { return port_; }

  void hang_up() override { connections_.hang_up(); }
  void set_present(bool present) override { acceptor_.set_open(present); }
  void announce(Event event, std::uint32_t parameter) override;

 private:
  NetworkLink(PtpBody& body, Descriptor bound, std::uint16_t port);
  void serve(int fd);
  void serve_host(int fd);
  void serve_events(int fd);
  bool take_seat();
  void leave_seat();

  PtpBody& body_;
  const Descriptor bound_;  ///< never listens: it keeps the port while the camera is off
  const std::uint16_t port_;
  std::mutex mutex_;
  std::condition_variable left_;
  bool taken_ = false;
  int events_fd_ = -1;
  Connections connections_;
  Acceptor acceptor_;  // last: ends first
};

}  // namespace weft::virtual_rig::ptp
