// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calibration/checks/rig_movement.h"
#include "core/base/json_document.h"
#include "solve/report/solve_report.h"

// What happened to a rig, for people and for programs.

namespace weft::calibration {

/// CAMERA_MOVED, TABLE_MOVED, LED_MOVED, LED_FADED, LEDS_EXCHANGED, ALL_FADED.
std::string name_of(ChangeKind kind);

/// "4 tags and 7 fixed points": what says where the camera is to the table; empty: nothing.
std::string place_evidence_words(const Movement& movement);

/// "LED 4 has moved by 5.1 mm (x 4.9 ± 0.2, y 1.3 ± 0.2, z -0.2 ± 0.4)", and what the evidence cannot tell
/// from it.
std::string sentence(const RigChange& change);

/// {"change", "led", "other_led", "turn_deg", "turn_sigma_deg", "shift_mm", "shift_sigma_mm", "factor",
/// "factor_sigma", "evidence", "or"}: those that this kind of change has.
Json json_of(const RigChange& change);

/// The change as a verdict, with what to do.
Verdict verdict_of(const RigChange& change);

}  // namespace weft::calibration
