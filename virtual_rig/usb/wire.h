// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// The cable between the stand-in for libusb in a host's process and a virtual camera: calls and replies over
/// a Unix socket on one machine, one at a time a connection. A connection that ends is a device that is gone.
namespace weft::virtual_rig::usb {

/// What the host's side asks for.
enum class UsbCall : std::uint32_t {
  kDescribe,   ///< replies with a Description
  kConfigure,  ///< set configuration, clear halt: what waits to be read is thrown away
  kClaim,      ///< needed for all below but events; ends with the connection
  kRelease,
  kReset,
  kControl,  ///< `value` is a class request; replies with its data
  kBulkOut,  ///< `length` bytes follow
  kBulkIn,   ///< at most `length` bytes come, one transfer's
  kEvents    ///< nothing is called on this connection any more; a reply with data comes an event
};

/// Before the data of a call.
struct CallHead {
  UsbCall call;
  std::uint32_t length;
  std::uint32_t timeout_ms;  ///< 0: none
  std::uint32_t value;
};

/// What stands at the other end of a cable.
struct Description {
  std::uint16_t product;  ///< USB's number of it
  std::uint8_t address;
};

/// How a call ended.
enum class UsbStatus : std::int32_t { kDone, kBusy, kTimeOut, kStall };

/// Before the data of a reply.
struct ReplyHead {
  UsbStatus status;
  std::uint32_t length;  ///< of the data that follow
};

constexpr std::uint16_t kNikon = 0x04b0;
constexpr std::uint16_t kPacket = 512;  ///< bytes, of the bulk endpoints; a shorter one ends a transfer

}  // namespace weft::virtual_rig::usb
