// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

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

#include "core/raw_frame.h"
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

  std::uint32_t get(std::uint16_t tag) const { return number(value_at(tag), 4); }

  std::size_t value_at(std::uint16_t tag) const {
    static constexpr std::size_t kTypeBytes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8};
    const std::size_t at = entry(tag);
    const bool inside = kTypeBytes[number(at + 2, 2)] * number(at + 4, 4) <= 4;
    return inside ? at + 8 : number(at + 8, 4);
  }
  /// Where the 12 bytes of a tag lie.
  std::size_t entry(std::uint16_t tag) const {
    const std::size_t directory = number(4, 4);
    for (std::size_t i = 0; i < number(directory, 2); ++i)
      if (number(directory + 2 + 12 * i, 2) == tag) return directory + 2 + 12 * i;
    throw std::runtime_error("no tag " + std::to_string(tag));
  }

  std::filesystem::path save(const std::string& name) const {
    const auto file = temp_file(name);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
  }

  std::vector<std::uint8_t> bytes;

 private:
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
