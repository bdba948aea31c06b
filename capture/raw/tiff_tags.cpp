// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/tiff_tags.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

namespace weft::capture {
namespace {

constexpr std::size_t kMostDirectories = 32;
constexpr std::size_t kMostTags = 512;
constexpr std::uint32_t kMostValues = 65536;
constexpr std::size_t kLongestText = 1024;
constexpr std::uint16_t kSubIfds = 330;

enum Type : std::uint16_t {
  kByte = 1,
  kAscii,
  kShort,
  kLong,
  kRational,
  kSByte,
  kUndefined,
  kSShort,
  kSLong,
  kSRational,
  kFloat,
  kDouble
};
constexpr std::array<std::size_t, 13> kValueBytes = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8};

std::size_t value_bytes(std::uint16_t type) {
  return type < kValueBytes.size() ? kValueBytes[type] : 0;
}

}  // namespace

std::uint64_t Tiff::unsigned_at(std::span<const std::uint8_t> bytes) const {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    number = number << 8 | bytes[big_endian_ ? i : bytes.size() - 1 - i];
  return number;
}

std::optional<Tiff> Tiff::read(ReadAt read_at) {
  std::array<std::uint8_t, 8> header;
  if (!read_at(0, header)) return {};
  const bool big_endian = header[0] == 'M' && header[1] == 'M';
  if (!big_endian && !(header[0] == 'I' && header[1] == 'I')) return {};

  Tiff tiff(std::move(read_at), big_endian);
  const std::span bytes(header);
  if (tiff.unsigned_at(bytes.subspan(2, 2)) != 42) return {};

  std::vector<std::uint32_t> pending = {static_cast<std::uint32_t>(tiff.unsigned_at(bytes.subspan(4, 4)))};
  std::set<std::uint32_t> seen;
  while (!pending.empty() && tiff.directories_.size() < kMostDirectories) {
    const std::uint32_t at = pending.back();
    pending.pop_back();
    if (at == 0 || !seen.insert(at).second) continue;
    const std::size_t before = tiff.directories_.size();
    pending.push_back(tiff.read_directory(at));
    if (tiff.directories_.size() == before) continue;
    for (const double child : tiff.numbers(tiff.directories_.back(), kSubIfds))
      if (child > 0 && child <= 0xffffffff && pending.size() < kMostDirectories)
        pending.push_back(static_cast<std::uint32_t>(child));
  }
  if (tiff.directories_.empty()) return {};
  return tiff;
}

/// Adds the directory at an offset if it is whole, and returns the offset of the next one; 0 for none.
std::uint32_t Tiff::read_directory(std::uint32_t at) {
  std::array<std::uint8_t, 2> count_bytes;
  if (!read_at_(at, count_bytes)) return 0;
  const std::size_t count = unsigned_at(count_bytes);
  if (count == 0 || count > kMostTags) return 0;
  std::vector<std::uint8_t> bytes(12 * count + 4);
  if (!read_at_(std::uint64_t{at} + 2, bytes)) return 0;

  TiffDirectory directory(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::span entry = std::span(bytes).subspan(12 * i, 12);
    TiffTag& tag = directory[i];
    tag.id = static_cast<std::uint16_t>(unsigned_at(entry.first(2)));
    tag.type = static_cast<std::uint16_t>(unsigned_at(entry.subspan(2, 2)));
    tag.count = static_cast<std::uint32_t>(unsigned_at(entry.subspan(4, 4)));
    const bool in_entry = std::uint64_t{tag.count} * value_bytes(tag.type) <= 4;
    tag.at = in_entry ? std::uint64_t{at} + 2 + 12 * i + 8 : unsigned_at(entry.subspan(8, 4));
  }
  directories_.push_back(std::move(directory));
  return static_cast<std::uint32_t>(unsigned_at(std::span(bytes).last(4)));
}

const TiffTag* Tiff::find(const TiffDirectory& directory, std::uint16_t id) {
  for (const TiffTag& tag : directory)
    if (tag.id == id) return &tag;
  return nullptr;
}

std::optional<std::vector<std::uint8_t>> Tiff::bytes(const TiffDirectory& directory, std::uint16_t id) const {
  if (std::count_if(directory.begin(), directory.end(), [id](const TiffTag& t) { return t.id == id; }) != 1)
    return {};
  const TiffTag& tag = *find(directory, id);
  if (tag.count > kMostValues) return {};
  std::vector<std::uint8_t> values(value_bytes(tag.type) * tag.count);
  if (!read_at_(tag.at, values)) return {};
  return values;
}

std::vector<double> Tiff::numbers(const TiffDirectory& directory, std::uint16_t id) const {
  const auto raw = bytes(directory, id);
  if (!raw || raw->empty() || find(directory, id)->type == kAscii) return {};
  const std::uint16_t type = find(directory, id)->type;
  std::vector<double> values;
  for (std::size_t at = 0; at < raw->size(); at += value_bytes(type)) {
    values.push_back(number_at(type, std::span(*raw).subspan(at, value_bytes(type))));
    if (!std::isfinite(values.back())) return {};
  }
  return values;
}

std::optional<std::string> Tiff::text(const TiffDirectory& directory, std::uint16_t id) const {
  const auto raw = bytes(directory, id);
  if (!raw || raw->size() > kLongestText || find(directory, id)->type != kAscii) return {};
  const auto end = std::find(raw->begin(), raw->end(), 0);
  const auto printable = [](std::uint8_t c) { return c >= ' ' && c <= '~'; };
  if (end == raw->end() || !std::all_of(raw->begin(), end, printable)) return {};
  return std::string(raw->begin(), end);
}

double Tiff::number_at(std::uint16_t type, std::span<const std::uint8_t> bytes) const {
  const auto half = [this, bytes](std::size_t i) { return unsigned_at(bytes.subspan(4 * i, 4)); };
  const auto as_signed = [](std::uint64_t n) { return static_cast<double>(static_cast<std::int32_t>(n)); };
  switch (type) {
    case kSByte:
      return static_cast<std::int8_t>(unsigned_at(bytes));
    case kSShort:
      return static_cast<std::int16_t>(unsigned_at(bytes));
    case kSLong:
      return as_signed(unsigned_at(bytes));
    case kRational:
      return static_cast<double>(half(0)) / static_cast<double>(half(1));
    case kSRational:
      return as_signed(half(0)) / as_signed(half(1));
    case kFloat:
      return std::bit_cast<float>(static_cast<std::uint32_t>(unsigned_at(bytes)));
    case kDouble:
      return std::bit_cast<double>(unsigned_at(bytes));
    default:
      return static_cast<double>(unsigned_at(bytes));
  }
}

std::optional<double> Tiff::number(const TiffDirectory& directory, std::uint16_t id,
                                   std::optional<double> otherwise) const {
  if (find(directory, id) == nullptr) return otherwise;
  const std::vector<double> values = numbers(directory, id);
  if (values.size() != 1) return {};
  return values[0];
}

}  // namespace weft::capture
