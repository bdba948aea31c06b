// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/base/result.h"

namespace weft::material {

/// SHA-256 of files. What a file was when it was read last spares reading it again and decides nothing else:
/// a file that was only touched is read, and has the digest that it had.
class DigestCache {
 public:
  /// The cache in `file`, empty where that cannot be read.
  explicit DigestCache(std::filesystem::path file);

  /// kNoInput.
  Result<std::string> digest(const std::filesystem::path& file);
  /// Writes what was found since; nothing where nothing was. Errors of write_file().
  Result<void> save() const;

  int hashed() const { return hashed_; }  ///< files that were read

 private:
  struct Known {
    std::uint64_t size = 0, inode = 0;
    std::int64_t changed_ns = 0;
    std::string sha256;
  };
  std::filesystem::path file_;
  std::map<std::string, Known> known_;
  bool is_changed_ = false;
  int hashed_ = 0;
};

}  // namespace weft::material
