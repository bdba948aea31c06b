// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/plain_counts.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace weft::capture {
namespace {

void unpack_packed(const std::uint8_t* from, int bits, std::vector<std::uint16_t>& to) {
  std::uint32_t held = 0;
  int held_bits = 0;
  for (std::uint16_t& count : to) {
    for (; held_bits < bits; held_bits += 8) held = held << 8 | *from++;
    held_bits -= bits;
    count = static_cast<std::uint16_t>(held >> held_bits & ((1u << bits) - 1));
  }
}

/// One row of a piece, from its first byte on.
void unpack_row(const PlainCounts& plain, const std::uint8_t* from, std::vector<std::uint16_t>& to) {
  if (plain.bits == 16) {
    const std::size_t high = plain.is_big_endian ? 0 : 1;
    for (std::size_t x = 0; x < to.size(); ++x)
      to[x] = static_cast<std::uint16_t>(from[2 * x + high] << 8 | from[2 * x + 1 - high]);
  } else {
    unpack_packed(from, plain.bits, to);
  }
  if (plain.table.empty()) return;
  for (std::uint16_t& count : to) count = plain.table[std::min<std::size_t>(count, plain.table.size() - 1)];
}

}  // namespace

bool read_plain_counts(const PlainCounts& plain, Size stored, Rect active, const ReadAt& read_at,
                       View<std::uint16_t> out) {
  const Size piece = plain.piece;
  const auto columns = static_cast<std::size_t>((stored.width + piece.width - 1) / piece.width);
  const std::size_t row_bytes =
      (static_cast<std::size_t>(piece.width) * static_cast<unsigned>(plain.bits) + 7) / 8;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> row(static_cast<std::size_t>(piece.width));
  for (std::size_t i = 0; i < plain.at.size(); ++i) {
    const int left = static_cast<int>(i % columns) * piece.width;
    const int top = static_cast<int>(i / columns) * piece.height;
    const int x0 = std::max(left, active.x0), x1 = std::min(left + piece.width, active.x1);
    const int y0 = std::max(top, active.y0), y1 = std::min(top + piece.height, active.y1);
    if (x0 >= x1 || y0 >= y1) continue;
    bytes.resize(row_bytes * static_cast<unsigned>(y1 - y0));
    if (!read_at(plain.at[i] + row_bytes * static_cast<unsigned>(y0 - top), bytes)) return false;
    for (int y = y0; y < y1; ++y) {
      unpack_row(plain, bytes.data() + row_bytes * static_cast<unsigned>(y - y0), row);
      std::copy(row.begin() + (x0 - left), row.begin() + (x1 - left),
                out.row(y - active.y0) + (x0 - active.x0));
    }
  }
  return true;
}

}  // namespace weft::capture
