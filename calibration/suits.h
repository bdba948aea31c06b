// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/calibration.h"
#include "core/raw_frame.h"
#include "core/result.h"
#include "core/session.h"

namespace weft::calibration {

/// Whether a calibration speaks of the rig, the body and the aperture that a session was taken with, and
/// measures every LED that the session lit. `frame` is what one of its raw files says of itself; fields it
/// leaves empty are not compared. Fails with kBadData and names the first thing that differs.
Result<void> suits(const Calibration& calibration, const Session& session, const ShotMetadata& frame);

}  // namespace weft::calibration
