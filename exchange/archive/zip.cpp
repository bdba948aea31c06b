// SPDX-License-Identifier: Apache-2.0
#include "exchange/archive/zip.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "exchange/archive/little_endian.h"
#include "exchange/document.h"

namespace weft::exchange {

namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();

Error bad_archive(const std::string& where, const std::string& why, const std::string& remedy) {
  return {ErrorKind::kBadData, "the archive cannot be written", where, why, remedy};
}

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// So that the bytes that follow `before` bytes, a header and a name begin at a multiple of 64.
std::string aligning_field(std::uint64_t before, std::size_t name_bytes) {
  std::size_t missing =
      (zip::kAlignment - (before + zip::kLocalBytes + name_bytes) % zip::kAlignment) % zip::kAlignment;
  if (missing == 0) return {};
  if (missing < 4) missing += zip::kAlignment;  // an extra field has a head of four bytes
  std::string field;
  put_u16(field, zip::kAligningField);
  put_u16(field, static_cast<std::uint16_t>(missing - 4));
  field.resize(missing, '\0');
  return field;
}

/// What both headers of an entry say alike, from "version needed" to the length of the name.
std::string common_fields(const ZipEntry& entry) {
  const auto size = static_cast<std::uint32_t>(entry.bytes.size());
  std::string fields;
  put_u16(fields, zip::kVersionNeeded);
  put_u16(fields, zip::kUtf8Flag);
  put_u16(fields, 0);  // stored
  put_u16(fields, zip::kTime);
  put_u16(fields, zip::kDate);
  put_u32(fields, crc_of(entry.bytes));
  put_u32(fields, size);
  put_u32(fields, size);
  put_u16(fields, static_cast<std::uint16_t>(entry.name.size()));
  return fields;
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

Result<void> check_entries(std::span<const ZipEntry> entries) {
  if (entries.empty() || entries.size() > 0xffff) {
    return bad_archive("entries", std::to_string(entries.size()) + " files are none or above 65535",
                       "write the files into a folder");
  }
  std::set<std::string> names;
  std::uint64_t bytes = 0;
  for (const ZipEntry& entry : entries) {
    if (auto path = check_portable_path(entry.name); !path) return path;
    if (entry.name.size() > 1000) {
      return bad_archive(entry.name.substr(0, 40), "its name is longer than 1000 bytes", "shorten it");
    }
    if (!names.insert(lower_case(entry.name)).second) {
      return bad_archive(entry.name, "another file has this name, but for the case of letters",
                         "give each file a name of its own");
    }
    bytes += entry.bytes.size() + 2 * entry.name.size() + 256;
  }
  if (bytes >= kMost) {
    return bad_archive("entries", std::to_string(bytes) + " bytes do not fit into 4 GiB",
                       "export with fewer pixels, or as a folder");
  }
  return {};
}

}  // namespace

Result<std::string> zip_of(std::span<const ZipEntry> entries, ZipKind kind) {
  if (auto checked = check_entries(entries); !checked) return checked.error();
  std::size_t bytes = zip::kEndBytes;
  for (const ZipEntry& entry : entries) bytes += entry.bytes.size() + 2 * entry.name.size() + 256;
  std::string out, directory;
  out.reserve(bytes);
  for (const ZipEntry& entry : entries) {
    const auto offset = static_cast<std::uint32_t>(out.size());
    const std::string common = common_fields(entry);
    const std::string extra =
        kind == ZipKind::kAligned ? aligning_field(out.size(), entry.name.size()) : std::string();
    put_u32(out, zip::kLocalMark);
    out += common;
    put_u16(out, static_cast<std::uint16_t>(extra.size()));
    out += entry.name;
    out += extra;
    out += entry.bytes;
    put_u32(directory, zip::kDirectoryMark);
    put_u16(directory, zip::kMadeBy);
    directory += common;
    for (int i = 0; i < 4; ++i) put_u16(directory, 0);  // extra field, comment, disk, internal attributes
    put_u32(directory, 0);                              // external attributes
    put_u32(directory, offset);
    directory += entry.name;
  }
  const auto offset = static_cast<std::uint32_t>(out.size());
  out += directory;
  put_u32(out, zip::kEndMark);
  put_u16(out, 0);
  put_u16(out, 0);
  put_u16(out, static_cast<std::uint16_t>(entries.size()));
  put_u16(out, static_cast<std::uint16_t>(entries.size()));
  put_u32(out, static_cast<std::uint32_t>(directory.size()));
  put_u32(out, offset);
  put_u16(out, 0);
  return out;
}

}  // namespace weft::exchange
