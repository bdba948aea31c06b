// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "calibration/response/response_frames.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// Reads dark/, ledNN/, ledNN+ledMM/ of `folder` and lists scale/ and trap/ (that of `trap`, where it names a
/// folder): raw frames of one body, ISO and
/// aperture, in each folder sorted by their exposure. A frame more than nine tenths of which are full in
/// every channel is left out. Memory: eight frames, and 100 bytes for 32 x 32 photosites a pair. Errors:
/// kNoInput (no such folder, no frames), kBadData (a frame of another body, ISO, aperture or size, or not
/// that of the calibration `from` where there is one; a developed picture; a frame that cannot be decoded; a
/// camera that ends below what its files call full).
Result<ResponseFrames> read_response_frames(const std::filesystem::path& folder,
                                            const std::filesystem::path& trap, const Calibration* from,
                                            const JobContext& context);

}  // namespace weft::calibration
