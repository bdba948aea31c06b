// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/dng_opcodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace weft::capture {
namespace {

constexpr std::array<std::uint16_t, 3> kOpcodeLists = {51008, 51009, 51022};
constexpr std::array kOpcodeNames = {
    "WarpRectilinear",  "WarpFisheye",     "FixVignetteRadial", "FixBadPixelsConstant",
    "FixBadPixelsList", "TrimBounds",      "MapTable",          "MapPolynomial",
    "GainMap",          "DeltaPerRow",     "DeltaPerColumn",    "ScalePerRow",
    "ScalePerColumn",   "WarpRectilinear2"};
constexpr std::uint32_t kGainMap = 9, kMostOpcodes = 256, kOptional = 1;
constexpr std::uint64_t kListHead = 4, kOpcodeHead = 16, kGainMapHead = 76;
constexpr std::uint32_t kMostGains = 65536, kGainOfOne = 0x3f800000;

/// Opcodes are big-endian in files of either order.
std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = at; i < at + 4; ++i) number = number << 8 | bytes[i];
  return number;
}

bool changes_nothing(const Tiff& tiff, std::uint64_t at, std::uint32_t size) {
  if (size <= kGainMapHead) return true;
  std::vector<std::uint8_t> gains((size - kGainMapHead) / 4 * 4);
  if (gains.size() > std::size_t{4} * kMostGains || !tiff.read_at(at + kGainMapHead, gains)) return false;
  for (std::size_t i = 0; i < gains.size(); i += 4)
    if (big_endian(gains, i) != kGainOfOne) return false;
  return true;
}

void add_list(const Tiff& tiff, const TiffTag& list, std::vector<std::string>& found) {
  std::array<std::uint8_t, kOpcodeHead> head;
  if (list.count < kListHead || !tiff.read_at(list.at, std::span(head).first(kListHead))) return;
  const std::uint32_t count = std::min(big_endian(head, 0), kMostOpcodes);
  const std::uint64_t end = list.at + list.count;
  std::uint64_t at = list.at + kListHead;
  for (std::uint32_t i = 0; i < count && at + kOpcodeHead <= end && tiff.read_at(at, head); ++i) {
    const std::uint32_t id = big_endian(head, 0), flags = big_endian(head, 8), size = big_endian(head, 12);
    at += kOpcodeHead;
    if (id != kGainMap || !changes_nothing(tiff, at, size)) {
      std::string name =
          id >= 1 && id <= kOpcodeNames.size() ? kOpcodeNames[id - 1] : fmt::format("opcode {}", id);
      if ((flags & kOptional) != 0) name += " (optional)";
      if (std::ranges::find(found, name) == found.end()) found.push_back(std::move(name));
    }
    at += size;
  }
}

}  // namespace

std::vector<std::string> opcodes_of(const Tiff& tiff, const TiffDirectory& directory) {
  std::vector<std::string> found;
  for (const std::uint16_t id : kOpcodeLists)
    if (const TiffTag* list = Tiff::find(directory, id)) add_list(tiff, *list, found);
  return found;
}

}  // namespace weft::capture
