// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

// Numbers in bytes, lowest first, and the fixed ones of zip archives (APPNOTE 6.3.10, 4.3 and 4.4).

namespace weft::exchange {

inline void put_u16(std::string& out, std::uint16_t value) {
  out += static_cast<char>(value & 0xff);
  out += static_cast<char>(value >> 8);
}
inline void put_u32(std::string& out, std::uint32_t value) {
  put_u16(out, static_cast<std::uint16_t>(value & 0xffff));
  put_u16(out, static_cast<std::uint16_t>(value >> 16));
}

namespace zip {

inline constexpr std::uint32_t kLocalMark = 0x04034b50, kDirectoryMark = 0x02014b50, kEndMark = 0x06054b50;
inline constexpr std::size_t kLocalBytes = 30, kDirectoryBytes = 46, kEndBytes = 22;
inline constexpr std::size_t kAlignment = 64;
inline constexpr std::uint16_t kMadeBy = 0x003f, kVersionNeeded = 0x14, kAligningField = 0x1986;
inline constexpr std::uint16_t kTime = 0, kDate = 0x21;  // 1980-01-01, the first day that the format knows
inline constexpr std::uint16_t kUtf8Flag = 0x0800;       // names are UTF-8

}  // namespace zip

}  // namespace weft::exchange
