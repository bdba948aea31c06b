// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/filesystem.h>

#include <filesystem>
#include <vector>

namespace weft {

/// The file below an image writer of OpenImageIO. It collects small writes, keeps the first error of the
/// system, and after that takes and drops everything, so that no encoder has to cope with a full disk.
class FileSink : public OIIO::Filesystem::IOProxy {
 public:
  /// Creates or empties `file`; `error_number` says whether that went well.
  explicit FileSink(const std::filesystem::path& file);
  ~FileSink() override;

  /// errno of the first failure, or 0.
  int error_number() const { return error_number_; }
  /// While set, writes before the end of the file are dropped.
  void only_append(bool yes) { only_append_ = yes; }
  /// Drops all that has not reached the file yet and all that follows.
  void abandon();
  /// Writes what is still held and closes the file; false on any failure so far.
  bool finish();

  const char* proxytype() const override { return "weft"; }
  std::size_t write(const void* data, std::size_t bytes) override;
  std::size_t size() const override { return static_cast<std::size_t>(end_); }

 private:
  void put(const void* data, std::size_t bytes, std::int64_t offset);
  void drain();

  int file_ = -1;
  int error_number_ = 0;
  bool only_append_ = false;
  std::int64_t end_ = 0;
  std::int64_t held_offset_ = 0;  ///< where the first byte of `held_` belongs
  std::vector<char> held_;
};

}  // namespace weft
