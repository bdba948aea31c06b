// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace weft {

/// The file below an encoder. It collects small writes, keeps the first error of the system, and after that
/// takes and drops everything, so that no encoder has to cope with a full disk.
class FileSink {
 public:
  /// Creates or empties `file`; `error_number` says whether that went well.
  explicit FileSink(const std::filesystem::path& file);
  ~FileSink();
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  /// errno of the first failure, or 0.
  int error_number() const { return error_number_; }
  /// Drops all that has not reached the file yet and all that follows.
  void abandon();
  /// Writes what is still held and closes the file; false on any failure so far.
  bool finish();

  void write(const void* data, std::size_t bytes);
  void seek(std::int64_t offset) { at_ = offset; }
  std::int64_t tell() const { return at_; }
  std::int64_t size() const { return end_; }

 private:
  void put(const void* data, std::size_t bytes, std::int64_t offset);
  void drain();

  int file_ = -1;
  int error_number_ = 0;
  std::int64_t at_ = 0;  ///< where the next byte belongs
  std::int64_t end_ = 0;
  std::int64_t held_offset_ = 0;  ///< where the first byte of `held_` belongs
  std::vector<char> held_;
};

}  // namespace weft
