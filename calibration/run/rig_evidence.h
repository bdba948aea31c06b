// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/camera/markers.h"
#include "calibration/checks/rig_movement.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "solve/photographs/photographs.h"

// What photographs show of the rig itself: tags and white patches on the table.

namespace weft::calibration {

/// Tags of one dictionary each of `dictionaries`, found in the first photographs of a session; corners are
/// means over at most three photographs in which the tag was found.
Result<std::vector<TagSighting>> tags_in(const solve::Photographs& photographs,
                                         const std::vector<std::string>& dictionaries);

/// Height of the tags on the table, rig frame: patches lie there, too, where nobody said how high they lie.
double tag_height_mm(const std::vector<Fiducial>& fiducials);

/// Where a patch is in the pictures of a camera that has moved: its own pixels by way of the plane of the
/// tags.
WhitePatch relocated(const WhitePatch& patch, const CameraModel& before, const CameraModel& now,
                     double plane_mm);

/// The tags that the calibration knows, and what its white patches read. Where tags say that the camera and
/// the table moved to each other, the patches are looked for where they are now. `lights` of readings are
/// those of `photographs.leds`; a LED that was left out has no reading.
Result<RigEvidence> rig_evidence(const Calibration& calibration, const solve::Photographs& photographs);

}  // namespace weft::calibration
