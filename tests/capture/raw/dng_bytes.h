// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/image/raw_frame.h"
#include "simulator/camera/dng_writer.h"

namespace weft::capture {

/// Counts that differ from site to site and from row to row.
inline RawFrame sample_frame(Size size) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      frame.counts(x, y) = static_cast<std::uint16_t>(600 + (7919 * x + 104729 * y) % 14900);
  frame.black = {{{600, 600}, {600, 600}}};
  frame.white = 15520;
  frame.shot = {"Lumitex", "Virtual D5100", "SN-0042", 1e6 / 60, 100, 8};
  return frame;
}

/// A file in a folder of this process alone, which goes with it: two builds may run their tests side by side.
inline std::filesystem::path temp_file(const std::string& name) {
  struct Folder {
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / ("weft_raw_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
  };
  static const Folder folder;
  return folder.path / name;
}

/// The bytes of a DNG of the simulator's, to be changed: values of a tag, or one tag made into another.
class DngBytes {
 public:
  explicit DngBytes(const RawFrame& frame = sample_frame({40, 30})) {
    const auto file = temp_file("template.dng");
    if (const auto done = simulator::write_dng(file, frame); !done)
      throw std::runtime_error(done.error().message());
    std::ifstream in(file, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
    std::filesystem::remove(file);
  }

  /// Makes a tag another one; its old value stays where it is.
  DngBytes& retag(std::uint16_t tag, std::uint16_t new_tag, std::uint16_t type, std::uint32_t count) {
    const std::size_t at = entry(tag);
    put(at, new_tag, 2), put(at + 2, type, 2), put(at + 4, count, 4);
    return *this;
  }
  DngBytes& remove(std::uint16_t tag) { return retag(tag, 65000, 1, 1); }

  /// Overwrites a tag's value, wherever it lies, by numbers of one size.
  DngBytes& set(std::uint16_t tag, std::initializer_list<std::uint32_t> numbers,
                std::size_t number_bytes = 4) {
    std::size_t at = value_at(tag);
    for (const std::uint32_t number : numbers) put(at, number, number_bytes), at += number_bytes;
    return *this;
  }

  /// Appends a number, for a tag that is to point at it.
  DngBytes& append(std::uint32_t value, std::size_t number_bytes) {
    bytes.resize(bytes.size() + number_bytes);
    put(bytes.size() - number_bytes, value, number_bytes);
    return *this;
  }
  /// Says that a tag's values lie elsewhere.
  DngBytes& point(std::uint16_t tag, std::uint32_t at) {
    put(entry(tag) + 8, at, 4);
    return *this;
  }

  bool has(std::uint16_t tag) const {
    const std::size_t directory = number(4, 4);
    for (std::size_t i = 0; i < number(directory, 2); ++i)
      if (number(directory + 2 + 12 * i, 2) == tag) return true;
    return false;
  }
  std::uint32_t get(std::uint16_t tag) const { return number(value_at(tag), 4); }

  std::size_t value_at(std::uint16_t tag) const { return value_of_entry(entry(tag)); }
  /// Where the 12 bytes of a tag lie.
  std::size_t entry(std::uint16_t tag) const {
    const std::size_t directory = number(4, 4);
    for (std::size_t i = 0; i < number(directory, 2); ++i)
      if (number(directory + 2 + 12 * i, 2) == tag) return directory + 2 + 12 * i;
    throw std::runtime_error("no tag " + std::to_string(tag));
  }

  /// Packs the counts of 16 bits into fewer, from the highest bit on and each row from a new byte.
  DngBytes& pack(int bits) {
    const std::uint32_t strip_at = get(273), width = get(256), height = get(257);
    std::vector<std::uint8_t> packed;
    for (std::size_t y = 0; y < height; ++y) {
      std::uint32_t held = 0;
      int held_bits = 0;
      for (std::size_t x = 0; x < width; ++x) {
        held = held << bits | number(strip_at + 2 * (y * width + x), 2);
        for (held_bits += bits; held_bits >= 8; held_bits -= 8)
          packed.push_back(static_cast<std::uint8_t>(held >> (held_bits - 8)));
      }
      if (held_bits > 0) packed.push_back(static_cast<std::uint8_t>(held << (8 - held_bits)));
    }
    bytes.resize(strip_at);
    bytes.insert(bytes.end(), packed.begin(), packed.end());
    return set(258, {static_cast<std::uint32_t>(bits)}, 2)
        .set(279, {static_cast<std::uint32_t>(packed.size())});
  }

  /// The same file with every number of its directories in big-endian order, and its counts where they have
  /// 16 bits. What is left takes no more changes.
  DngBytes& make_big_endian() {
    if (get(258) == 16)
      for (std::size_t at = get(has(324) ? 324 : 273); at < bytes.size(); at += 2) reverse(at, 2);
    reverse_directory(get(34665));
    reverse_directory(number(4, 4));
    reverse(4, 4);
    bytes[0] = bytes[1] = 'M', bytes[2] = 0, bytes[3] = 42;
    return *this;
  }

  std::filesystem::path save(const std::string& name) const {
    const auto file = temp_file(name);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
  }

  std::vector<std::uint8_t> bytes;

 private:
  static constexpr std::size_t kTypeBytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8};

  std::size_t value_of_entry(std::size_t at) const {
    const bool inside = kTypeBytes[number(at + 2, 2)] * number(at + 4, 4) <= 4;
    return inside ? at + 8 : number(at + 8, 4);
  }
  void reverse(std::size_t at, std::size_t size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  }
  void reverse_directory(std::size_t directory) {
    const std::size_t count = number(directory, 2);
    for (std::size_t at = directory + 2; at < directory + 2 + 12 * count; at += 12) {
      const std::uint32_t type = number(at + 2, 2), values = number(at + 4, 4);
      const bool is_rational = type == 5 || type == 10;
      const std::size_t parts = is_rational ? 2 : 1, value_at = value_of_entry(at);
      for (std::size_t i = 0; i < parts * values; ++i)
        reverse(value_at + i * kTypeBytes[type] / parts, kTypeBytes[type] / parts);
      if (value_at != at + 8) reverse(at + 8, 4);
      reverse(at, 2), reverse(at + 2, 2), reverse(at + 4, 4);
    }
    reverse(directory, 2);
  }
  std::uint32_t number(std::size_t at, std::size_t size) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, size);
    return value;
  }
  void put(std::size_t at, std::uint32_t value, std::size_t size) {
    std::memcpy(bytes.data() + at, &value, size);
  }
};

}  // namespace weft::capture
