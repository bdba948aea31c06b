// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <libraw/libraw.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "capture/raw/dng_layout.h"
#include "capture/raw/raw_info.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace weft::capture {

/// A file as LibRaw reads it. Some decoders of LibRaw 0.20 take what they find in memory for data where the
/// file has ended, so the bytes that were asked for and not there are counted.
class CountedFile final : public LibRaw_file_datastream {
 public:
  using LibRaw_file_datastream::LibRaw_file_datastream;
  int read(void* to, std::size_t size, std::size_t count) override;
  int get_char() override;

  std::uint64_t missing_bytes = 0;
};

/// A raw file that LibRaw has opened and not yet unpacked, and whose header passed every check there is.
struct OpenedRaw {
  std::unique_ptr<CountedFile> file;  ///< which outlives `libraw`
  std::unique_ptr<LibRaw> libraw;     ///< 766 kB: too large for a stack
  RawInfo info;
  Rect active;                   ///< the active area on LibRaw's raw image
  std::optional<DngLayout> dng;  ///< only for a DNG
};

Result<OpenedRaw> open_raw(const std::filesystem::path& file);

/// The error of a file that LibRaw has no memory for.
Error out_of_memory(const std::string& where);

/// The error of a file that LibRaw unpacks to something that is not the sensor's counts with their levels.
Error distrust(std::string why, const std::string& where);

}  // namespace weft::capture
