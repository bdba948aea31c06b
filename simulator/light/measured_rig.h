// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/rig/lights.h"

namespace weft::simulator {

/// The LEDs of a rig that somebody measured, in the rig frame, from either of two kinds of JSON:
/// - lights.json of a calibration (weft.lights/1, near lights). Its gains over the frame stay behind: they
///   are the camera's, for which a scene has its vignette.
/// - {"leds": [{"position_mm", "direction", "mu", "flux_rgb"}]} as published rigs come: in the frame of a
///   camera with x to the right, y down and z away from it, which is taken to stand straight above the
///   table's centre at `camera_distance_mm`, so that (x, y, z) lies at (x, -y, distance - z).
/// kNoInput if the file is not there; kBadData names the field that is missing or makes no sense: a
/// direction without length, mu below 0, a flux not above 0, no LEDs or more than 256.
Result<std::vector<NearLight>> read_measured_rig(const std::filesystem::path& file,
                                                 double camera_distance_mm);

}  // namespace weft::simulator
