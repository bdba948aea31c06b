// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "calibration/camera/pose.h"
#include "calibration/checks/rig_movement.h"
#include "core/rig/calibration.h"

namespace weft::test {

/// Ten LEDs, a camera of 1536 x 1024 pixels straight above 200 mm of table, a tag near each corner and two
/// white patches beside each.
Calibration calibrated_rig();

/// What has happened to it.
struct Mishap {
  calibration::Pose table;      ///< where the table's points went
  calibration::Pose camera;     ///< where the camera's body went
  std::vector<NearLight> leds;  ///< as they are now
};
Mishap no_mishap(const Calibration& rig);

/// Tags and patches as they are seen then, by the simulator's law of light, with 0.05 pixels of noise on
/// corners, 0.03 percent on readings, 0.1 percent of flicker a LED and 0.3 percent of dirt a patch.
calibration::RigEvidence seen(const Calibration& rig, const Mishap& mishap, std::uint64_t seed);

/// The same and a flat white sheet of unknown reflectance on the table, read in 5 x 4 places, whose own tags
/// give its place through the camera as it was calibrated.
calibration::RigEvidence seen_with_sheet(const Calibration& rig, const Mishap& mishap, std::uint64_t seed);

}  // namespace weft::test
