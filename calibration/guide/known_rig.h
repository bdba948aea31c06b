// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "core/rig/lights.h"
#include "solver/light_plan/planned_rig.h"

namespace weft::calibration {

/// What a file says of a rig whose lights are to be thought about.
struct KnownRig {
  std::string name, where;
  NearLights lights;
  std::optional<Calibration> calibration;
  double cloth_height_mm = 0, exposure_s = 0.5;
};

/// Reads a rig file or the folder of a calibration. kBadData where the lights have no places; errors of
/// read_rig() and read_calibration().
Result<KnownRig> read_known_rig(const std::filesystem::path& path);

/// Its lights over nine places of the frame. Where no calibration says it, the camera is 600 mm above a frame
/// of 180 x 120 mm, and LEDs are as well known as is typical. kBadData where a LED touches the cloth.
Result<solver::ForeseenRig> foreseen_of(const KnownRig& rig);

}  // namespace weft::calibration
