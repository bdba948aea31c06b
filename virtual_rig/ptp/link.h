// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "virtual_rig/ptp/bytes.h"
#include "virtual_rig/ptp/codes.h"

/// What passes between a camera's body and the links that carry PTP to it.
namespace weft::virtual_rig::ptp {

/// An operation that a host asks for.
struct Request {
  std::uint16_t operation = 0;
  std::array<std::uint32_t, 5> parameters = {};
};

/// How a link is to deliver an answer: some faults of a body show on the wire.
enum class Delivery {
  kWhole,
  kNothing,  ///< no answer at all
  kHangUp,   ///< the link breaks instead
  kHalfThenHangUp,
  kHalfThenNothing,
  kHalfAsWhole,  ///< half the data as if all, then the response
  kTimeOut,      ///< as kNothing, and a bus that can says at once that time is out
};

/// Bytes that a body shares with the link that sends them, so that a picture is in memory once.
struct Payload {
  std::shared_ptr<const Bytes> owner;
  BytesView bytes;

  static Payload of(Bytes bytes) {
    const auto owner = std::make_shared<const Bytes>(std::move(bytes));
    return {owner, *owner};
  }
};

/// What the body answers, and how it is to arrive.
struct Answer {
  ResponseCode code = kOk;
  std::vector<std::uint32_t> parameters = {};
  std::optional<Payload> data = {};  ///< none: no data phase
  Delivery delivery = Delivery::kWhole;
};

/// A way to the camera. A body calls these with its lock held: they must not call the body.
class Link {
 public:
  virtual ~Link() = default;
  /// Whoever is connected is so no more.
  virtual void hang_up() = 0;
  /// Whether there is something to connect to. A bus loses what it has when that goes; a network does not.
  virtual void set_present(bool present) = 0;
  virtual void announce(Event event, std::uint32_t parameter) = 0;
};

}  // namespace weft::virtual_rig::ptp
