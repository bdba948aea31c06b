// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "virtual_rig/ptp/bytes.h"

/// The datasets of PTP (ISO 15740, clause 5) that a camera hands out.
namespace weft::virtual_rig::ptp {

/// A count of characters with their NUL, then UTF-16; text is ASCII here, at most 254 characters.
void put_string(ByteWriter& writer, std::string_view text);
/// Nothing if cut off, not ended by NUL or not ASCII.
std::optional<std::string> get_string(ByteReader& reader);

/// What a camera says it is and can do.
struct DeviceFacts {
  std::string model, serial;
  std::vector<std::uint16_t> operations, events, properties;
};
Bytes device_info(const DeviceFacts& facts);

/// What a camera says of a file or a folder.
struct ObjectFacts {
  std::uint32_t storage = 0;  ///< 0: the body's memory
  std::uint16_t format = 0;
  std::uint32_t bytes = 0;
  std::uint32_t parent = 0;
  Size size = {};  ///< of a picture; empty for a folder
  std::string name = {};
  std::string date = {};  ///< "20260131T235958"
};
Bytes object_info(const ObjectFacts& facts);

/// Describes the one card.
Bytes storage_info();

}  // namespace weft::virtual_rig::ptp
