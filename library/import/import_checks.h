// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "library/import/description.h"
#include "library/import/source_frame.h"

// Whether photographs can be one session of a rig.

namespace weft::library {

/// Whether frames are of one kind, body, size, exposure, ISO, aperture and focal length, as far as they say.
/// kBadData names those that differ from most.
Result<void> check_alike(const std::vector<SourceFrame>& frames);

/// The first of these errors, which names the files of the others.
Result<void> check_readable(const std::vector<Error>& unreadable);

/// Whether both can be read and are alike to the last byte.
bool hold_same_bytes(const std::filesystem::path& a, const std::filesystem::path& b);

/// What all frames of a session were set to.
struct CommonSetting {
  double exposure_us = 0, iso = 0, f_number = 0;
};

/// By the frames, else by what people said, of the aperture else by the calibration. kBadData where nothing
/// says exposure or ISO.
Result<CommonSetting> setting_of(const std::vector<SourceFrame>& frames, const ImportDescription& said,
                                 const Calibration& calibration);

/// Whether a calibration suits the session that is to be made: core/rig/suits.h, and the size of the picture.
Result<void> check_calibration(const Calibration& calibration, const Session& session,
                               const SourceFrame& frame);

/// Whether a session that is there holds these frames under these LEDs: shots in the same order, by LED, role
/// and content. Errors of reading.
Result<bool> is_same_session(const Session& there, const Session& wanted,
                             const std::vector<SourceFrame>& frames);

}  // namespace weft::library
