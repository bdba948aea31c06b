// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "capture/raw/tiff_tags.h"
#include "core/base/result.h"

namespace weft::capture {

/// What a photograph says of itself: in the header of a TIFF or a raw, in the EXIF of a JPEG or a PNG. What
/// it does not say is empty or 0.
struct PhotographFacts {
  /// By its content: "dng", "nef", "cr2", "arw", "pef"; "cr3", "rw2", "orf", "raf", "crw", "mrw", "x3f", raws
  /// of which nothing else is read; "tif", "jpg"; empty: none of these.
  std::string ending;
  std::uint64_t data_end = 0;  ///< the file's least size in bytes, by where its image data lie
  /// EXIF ImageNumber (TIFF/EP 0x9211), or the shutter count of a Nikon's maker note (0x00A7).
  std::optional<std::uint32_t> image_number;
  /// DateTimeOriginal with SubSecTimeOriginal: seconds since 1970 if the camera's clock showed UTC.
  std::optional<double> taken_s;
  double resolution_s = 1;       ///< steps of taken_s: 1 without sub-seconds
  std::optional<double> zone_s;  ///< OffsetTimeOriginal: what the camera's clock is ahead of UTC
  double exposure_us = 0;
  double iso = 0;
  double f_number = 0;
  std::string model, lens;
  int orientation = 1;  ///< how stored rows are to be shown (TIFF 6.0, tag 274), 1 to 8; 1: as they are
};

/// Whether this ending is that of a raw file whose header is read.
bool is_raw_ending(const std::string& ending);

/// Whether a file is a raw by its name, IMG_1.CR3, whether or not its header is read.
bool is_raw_name(const std::filesystem::path& file);

/// Whether this ending is that of a raw file whose header is not read.
bool is_unread_raw_ending(const std::string& ending);

/// Reads the header of any file; nothing in it is believed that does not make sense.
PhotographFacts photograph_facts(const ReadAt& read_at);

/// kNoInput where the file cannot be read.
Result<PhotographFacts> read_photograph_facts(const std::filesystem::path& file);

}  // namespace weft::capture
