// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace weft::virtual_rig::ptp {

using Bytes = std::vector<std::uint8_t>;
using BytesView = std::span<const std::uint8_t>;

/// Puts numbers one behind the other, little-endian.
class ByteWriter {
 public:
  template <std::integral T>
  ByteWriter& put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> 8 * i));
    return *this;
  }
  ByteWriter& put(BytesView bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  /// As PTP has them: their number, then they.
  template <std::integral T>
  ByteWriter& put_array(const std::vector<T>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    for (const T value : values) put(value);
    return *this;
  }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Gets little-endian numbers; nothing once the bytes are too few.
class ByteReader {
 public:
  explicit ByteReader(BytesView bytes) : bytes_(bytes) {}

  template <std::integral T>
  std::optional<T> get() {
    if (bytes_.size() < sizeof(T)) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value |= std::uint64_t{bytes_[i]} << 8 * i;
    bytes_ = bytes_.subspan(sizeof(T));
    return static_cast<T>(value);
  }
  BytesView rest() const { return bytes_; }

 private:
  BytesView bytes_;
};

}  // namespace weft::virtual_rig::ptp
