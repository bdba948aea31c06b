// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace weft::capture {

/// Fills `bytes` from an offset of a file; false where the file ends before that or cannot be read.
using ReadAt = std::function<bool(std::uint64_t offset, std::span<std::uint8_t> bytes)>;

/// One field of a TIFF directory: `count` values of a type of TIFF 6.0, the first of them at offset `at`.
struct TiffTag {
  std::uint16_t id = 0;
  std::uint16_t type = 0;
  std::uint32_t count = 0;
  std::uint64_t at = 0;
};
using TiffDirectory = std::vector<TiffTag>;

/// The directories of a classic TIFF (Adobe, TIFF revision 6.0, 1992), in either byte order: the main chain
/// and the SubIFDs. Meant for files nobody has checked: reads at most 32 directories of at most 512 tags,
/// follows no offset twice, and holds no more than one directory's and one tag's bytes at a time.
class Tiff {
 public:
  /// Nothing where the file does not start as a classic TIFF with a first directory.
  static std::optional<Tiff> read(ReadAt read_at);

  const std::vector<TiffDirectory>& directories() const { return directories_; }
  bool is_big_endian() const { return big_endian_; }
  bool read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const { return read_at_(offset, bytes); }

  /// Null where the tag is absent.
  static const TiffTag* find(const TiffDirectory& directory, std::uint16_t id);

  /// The values of a tag. Empty where the tag is absent or there twice, has over 65 536 values, is no number,
  /// lies beyond the end of the file, or holds a value that is not finite.
  std::vector<double> numbers(const TiffDirectory& directory, std::uint16_t id) const;

  /// The only value of a tag; `otherwise` where the tag is absent; nothing where it is there and wrong.
  std::optional<double> number(const TiffDirectory& directory, std::uint16_t id,
                               std::optional<double> otherwise = {}) const;

  /// The text of an ASCII tag up to its NUL. Nothing where the tag is absent or there twice, longer than 1024
  /// bytes, without a NUL, or not printable.
  std::optional<std::string> text(const TiffDirectory& directory, std::uint16_t id) const;

 private:
  /// The bytes of a tag's values; nothing where it is absent, there twice, too long or beyond the end.
  std::optional<std::vector<std::uint8_t>> bytes(const TiffDirectory& directory, std::uint16_t id) const;
  Tiff(ReadAt read_at, bool big_endian) : read_at_(std::move(read_at)), big_endian_(big_endian) {}
  std::uint64_t unsigned_at(std::span<const std::uint8_t> bytes) const;
  double number_at(std::uint16_t type, std::span<const std::uint8_t> bytes) const;
  std::uint32_t read_directory(std::uint32_t at);

  ReadAt read_at_;
  bool big_endian_ = false;
  std::vector<TiffDirectory> directories_;
};

}  // namespace weft::capture
