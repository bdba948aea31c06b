// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::capture {

/// What the header of a raw file says.
struct RawInfo {
  Size size;       ///< of the active area
  CfaPattern cfa;  ///< of the active area's (0, 0)
  ShotMetadata shot;
  std::vector<std::string> opcodes = {};  ///< as of DngLayout
};

/// Opens a raw file and decodes no pixels: a millisecond a file, to look over a session before an hour of
/// work. Refuses with the same errors as decode_raw() all that can be told before decoding.
Result<RawInfo> read_raw_info(const std::filesystem::path& file);

}  // namespace weft::capture
