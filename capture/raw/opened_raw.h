// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <libraw/libraw.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "capture/raw/dng_layout.h"
#include "capture/raw/raw_info.h"
#include "core/image.h"
#include "core/result.h"

namespace weft::capture {

/// A raw file that LibRaw has opened and not yet unpacked, and whose header passed every check there is.
struct OpenedRaw {
  std::unique_ptr<LibRaw> libraw;  ///< 766 kB: too large for a stack
  RawInfo info;
  Rect active;                   ///< the active area on LibRaw's raw image
  std::optional<DngLayout> dng;  ///< only for a DNG
};

Result<OpenedRaw> open_raw(const std::filesystem::path& file);

/// The error of a file that LibRaw cannot unpack.
Error unpack_error(int code, const std::string& where);

/// The error of a file that LibRaw unpacks to something that is not the sensor's counts with their levels.
Error distrust(std::string why, const std::string& where);

}  // namespace weft::capture
