// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"

namespace weft {

/// How the focal length of a frame differs from another ("focal length 40 mm, not 35: ..."); nothing where it
/// does not, or where one of them is 0: not known.
std::optional<std::string> focal_difference(double frame_mm, double other_mm);

/// How the body, the aperture or the focal length of a frame differs from what a calibration holds for ("the
/// calibration is of a ..., the frame of a ..."); nothing where it does not. What either of them does not say
/// is not compared.
std::optional<std::string> subject_difference(const CalibrationSubject& subject, const ShotMetadata& frame);

/// Whether a calibration speaks of the rig, the body, the aperture, the focal length and the ISO that a
/// session was taken with, and measures every LED that the session lit. `frame` is what one of its raw files
/// says of itself; fields it leaves empty are not compared. Fails with kBadData and names the first thing
/// that differs.
Result<void> suits(const Calibration& calibration, const Session& session, const ShotMetadata& frame);

}  // namespace weft
