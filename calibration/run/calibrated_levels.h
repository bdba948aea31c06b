// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// Whether a count means the same light in a raw file as in those that a response was measured on: black to
/// white is as far, within 0.5 percent. A response that does not say its levels takes any. kBadData, naming
/// the file.
Result<void> check_levels(const RawFrame& frame, const Response& response, const std::filesystem::path& file);

}  // namespace weft::calibration
