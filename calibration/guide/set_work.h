// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/guide/photograph_set.h"
#include "calibration/guide/set_guide.h"
#include "capture/devices.h"
#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/base/result.h"

namespace weft::calibration {

/// The LEDs by which a board is photographed: LED 1 and the one across from it, for even light; LED 1 alone
/// where nobody knows where they are.
std::vector<int> board_leds(const capture::Rig& rig, const PhotographSet& set);

/// Photographs what a step of a set asks for, metering where nobody did. What was taken stays after an error.
/// Errors: those of capture::Series and capture::scan().
Result<void> take_step(PhotographSet& set, const SetStep& step, const capture::Rig& rig,
                       capture::Lamps& lamps, capture::Camera& camera, const capture::ScanEvents& events,
                       const capture::ScanControl& control);

}  // namespace weft::calibration
