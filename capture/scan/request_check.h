// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "capture/devices.h"
#include "capture/scan/scan.h"
#include "capture/scan/scan_plan.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

namespace weft::capture {

/// Everything that can be known to be wrong before a shot. kBadData, kUsage and kCannotCreate with what to
/// do.
Result<ShotList> checked_shots(const ScanRequest& request, int leds_of_board, bool has_more_outputs,
                               const std::optional<Calibration>& calibration);

/// Whether rig, camera, aperture and ISO are those that the calibration is of.
Result<void> check_calibration(const ScanRequest& request, const CameraFacts& camera,
                               const Calibration& calibration);

/// Whether there is room for `frames` more frames of `bytes` each in the session, and for `all` of them in
/// the second copy. kInputOutput.
Result<void> check_room(const ScanRequest& request, int frames, int all, std::uint64_t bytes);

}  // namespace weft::capture
