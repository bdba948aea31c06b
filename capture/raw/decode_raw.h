// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::capture {

/// What the caller knows about a frame before it is decoded.
struct DecodeExpectation {
  std::optional<Size> size = {};  ///< of the active area
  std::optional<CfaPattern> cfa = {};
  std::optional<std::string> model = {};
};

/// Decodes the counts of a raw file as the sensor gave them: nothing is scaled, demosaiced, cropped further
/// than to the active area, or turned. The orientation that a file asks to be shown in is ignored: it is what
/// the body felt last, and one that looks straight down feels nothing. Takes any Bayer raw of a camera that
/// LibRaw knows, and DNG (see dng_layout.h). Safe to call from many threads at once.
///
/// Errors: kNoInput (absent, or may not be read), kTryAgain (out of memory), kBadData (no raw file, truncated
/// or damaged, not as expected, or one that LibRaw would decode wrongly: not Bayer, no or impossible
/// black and white levels, a header that contradicts its data).
Result<RawFrame> decode_raw(const std::filesystem::path& file, const DecodeExpectation& expected = {});

}  // namespace weft::capture
