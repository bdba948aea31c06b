// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

/// A white patch as it was read.
struct SeenPatch {
  double x_px = 0, y_px = 0;
  /// By LED, of those of `photographs.leds`; NaN: it was left out, or the patch is full or not in the frame.
  std::vector<std::array<double, 3>> reading_rgb = {};
  double sigma = 0;  ///< LitPlace::reading_sigma
};
/// What photographs show of the rig, whatever calibration that is held against.
struct RigSightings {
  std::vector<TagSighting> tags;
  std::vector<SeenPatch> patches;
};

/// Tags of the calibration's kinds, and what its white patches read. Where tags say that the camera and the
/// table moved to each other, the patches are looked for where they are now.
Result<RigSightings> sightings_in(const Calibration& calibration, const solve::Photographs& photographs);

/// The same as evidence for or against a calibration, whose patches are paired with what was read inside
/// them: another one than the photographs were taken with may have others.
RigEvidence evidence_of(const Calibration& calibration, const RigSightings& sightings);

}  // namespace weft::calibration
