// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <set>

#include "exchange/archive/little_endian.h"
#include "exchange/document.h"
#include "tests/exchange/export_checks.h"

namespace weft::exchange {

namespace {

/// The caller knows that the bytes are there.
std::uint16_t u16_at(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[at]) |
                                    (static_cast<unsigned char>(bytes[at + 1]) << 8));
}
std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  return u16_at(bytes, at) | (std::uint32_t{u16_at(bytes, at + 2)} << 16);
}

Error unlike_zip(const std::string& where, const std::string& why) {
  return {ErrorKind::kBadData, "the archive is not as its format asks", where, why,
          "write it again with weft export"};
}

/// One entry, as its line in the directory has it.
struct Listed {
  std::string name;
  std::string_view common;  // what both headers say alike
  std::size_t offset = 0, size = 0;
  std::uint32_t crc = 0;
};

class Checker {
 public:
  Checker(std::string_view bytes, ZipKind kind) : bytes_(bytes), kind_(kind) {}

  Result<void> check() {
    if (auto end = read_end(); !end) return end;
    for (std::size_t i = 0; i < count_; ++i) {
      if (auto entry = check_entry(i); !entry) return entry;
    }
    if (directory_at_ != end_at_) return unlike_zip("directory", "its size is not that of its entries");
    if (next_ != directory_begin_) return unlike_zip("directory", "something lies before it");
    return {};
  }

 private:
  Result<void> read_end() {
    if (bytes_.size() < zip::kEndBytes) return unlike_zip("end", "the file is too short");
    end_at_ = bytes_.size() - zip::kEndBytes;
    if (u32_at(bytes_, end_at_) != zip::kEndMark || u16_at(bytes_, end_at_ + 20) != 0) {
      return unlike_zip("end", "the record that ends an archive is not its last 22 bytes");
    }
    count_ = u16_at(bytes_, end_at_ + 10);
    directory_at_ = directory_begin_ = u32_at(bytes_, end_at_ + 16);
    if (u32_at(bytes_, end_at_ + 4) != 0 || u16_at(bytes_, end_at_ + 8) != count_ || count_ == 0) {
      return unlike_zip("end", "it counts no entries, or speaks of several disks");
    }
    if (std::uint64_t{directory_at_} + u32_at(bytes_, end_at_ + 12) != end_at_) {
      return unlike_zip("end", "the directory does not end where this record begins");
    }
    return {};
  }

  Result<Listed> read_listed(std::size_t index) {
    const std::string where = "entry " + std::to_string(index + 1);
    if (end_at_ - directory_at_ < zip::kDirectoryBytes ||
        u32_at(bytes_, directory_at_) != zip::kDirectoryMark) {
      return unlike_zip(where, "the directory has no line for it");
    }
    const std::size_t at = directory_at_;
    const std::size_t name_bytes = u16_at(bytes_, at + 28);
    if (end_at_ - at - zip::kDirectoryBytes < name_bytes) return unlike_zip(where, "its name is cut off");
    Listed listed = {std::string(bytes_.substr(at + zip::kDirectoryBytes, name_bytes)),
                     bytes_.substr(at + 6, 24), u32_at(bytes_, at + 42), u32_at(bytes_, at + 24),
                     u32_at(bytes_, at + 16)};
    directory_at_ += zip::kDirectoryBytes + name_bytes;
    if (auto path = check_portable_path(listed.name); !path) return unlike_zip(where, path.error().why);
    if (!names_.insert(listed.name).second) return unlike_zip(listed.name, "it is there twice");
    for (const std::size_t zero : {30u, 32u, 34u, 36u, 38u, 40u}) {
      if (u16_at(bytes_, at + zero) != 0) {
        return unlike_zip(listed.name, "it has an extra field, a comment, a disk or attributes");
      }
    }
    if (u16_at(bytes_, at + 4) != zip::kMadeBy) return unlike_zip(listed.name, "made by is not 0x003F");
    return listed;
  }

  Result<void> check_common(const Listed& listed) const {
    const std::string_view common = listed.common;
    if (u16_at(common, 0) != zip::kVersionNeeded) return unlike_zip(listed.name, "needed is not 0x14");
    if (u16_at(common, 2) != zip::kUtf8Flag) {
      return unlike_zip(listed.name, "its flags are not bit 11 alone");
    }
    if (u16_at(common, 4) != 0 || u32_at(common, 14) != u32_at(common, 18)) {
      return unlike_zip(listed.name, "it is not stored as it is");
    }
    return {};
  }

  Result<void> check_extra(const Listed& listed, std::string_view extra, std::size_t payload_at) const {
    if (kind_ == ZipKind::kStrict) {
      return extra.empty() ? Result<void>() : unlike_zip(listed.name, "it has an extra field");
    }
    if (payload_at % zip::kAlignment != 0) {
      return unlike_zip(listed.name,
                        "its bytes begin at " + std::to_string(payload_at) + ", which is no multiple of 64");
    }
    if (extra.empty()) return {};
    const bool is_empty = extra.substr(std::min<std::size_t>(extra.size(), 4)).find_first_not_of('\0') ==
                          std::string_view::npos;
    const bool is_whole = is_empty && extra.size() >= 4 && std::size_t{u16_at(extra, 2)} + 4 == extra.size();
    if (!is_whole || u16_at(extra, 0) != zip::kAligningField) {
      return unlike_zip(listed.name, "its extra field is not one of zeros with the id 0x1986");
    }
    return {};
  }

  Result<void> check_entry(std::size_t index) {
    auto read = read_listed(index);
    if (!read) return read.error();
    const Listed& listed = *read;
    if (auto common = check_common(listed); !common) return common;
    if (listed.offset != next_) return unlike_zip(listed.name, "something lies before it, or it overlaps");
    const std::size_t room = directory_begin_ - std::min(next_, directory_begin_);
    const std::size_t head = zip::kLocalBytes + listed.name.size();
    if (room < head || u32_at(bytes_, next_) != zip::kLocalMark) {
      return unlike_zip(listed.name, "it has no header of its own");
    }
    if (bytes_.substr(next_ + 4, 24) != listed.common ||
        bytes_.substr(next_ + zip::kLocalBytes, listed.name.size()) != listed.name) {
      return unlike_zip(listed.name, "its two headers differ");
    }
    const std::size_t extra_bytes = u16_at(bytes_, next_ + 28);
    if (room - head < extra_bytes || room - head - extra_bytes < listed.size) {
      return unlike_zip(listed.name, "it reaches into the directory");
    }
    const std::size_t payload_at = next_ + head + extra_bytes;
    if (auto extra = check_extra(listed, bytes_.substr(next_ + head, extra_bytes), payload_at); !extra) {
      return extra;
    }
    const auto* payload = reinterpret_cast<const Bytef*>(bytes_.data() + payload_at);
    if (crc32_z(0, payload, listed.size) != listed.crc) {
      return unlike_zip(listed.name, "its checksum is another");
    }
    next_ = payload_at + listed.size;
    return {};
  }

  std::string_view bytes_;
  ZipKind kind_;
  std::size_t end_at_ = 0, count_ = 0, directory_at_ = 0, directory_begin_ = 0;
  std::size_t next_ = 0;  // where the next entry must begin
  std::set<std::string> names_;
};

}  // namespace

Result<void> check_zip(std::string_view bytes, ZipKind kind) {
  return Checker(bytes, kind).check();
}

}  // namespace weft::exchange
