// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "virtual_rig/ptp/body.h"
#include "virtual_rig/ptp/bytes.h"

/// PTP/IP (CIPA DC-005) as packets on streams, whatever carries these.
namespace weft::virtual_rig::ptp {

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

}  // namespace weft::virtual_rig::ptp
