// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/camera/fixed_points.h"
#include "calibration/camera/markers.h"
#include "calibration/checks/rig_movement.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "solve/photographs/photographs.h"

// What photographs show of the rig itself: tags, fixed points and white patches on the table.

namespace weft::calibration {

/// Tags of one dictionary each of `dictionaries`, found in the first photographs of a session; corners are
/// means over at most three photographs in which the tag was found.
Result<std::vector<TagSighting>> tags_in(const solve::Photographs& photographs,
                                         const std::vector<std::string>& dictionaries);

/// Those fixed points that are in sight, in the light of all photographs together.
std::vector<PointSighting> points_in(const solve::Photographs& photographs, const Calibration& calibration);

/// Height of the tags on the table, rig frame: fixed points lie there, too, and patches, where nobody said
/// how high they lie.
double tag_height_mm(const std::vector<Fiducial>& fiducials);

/// Where a patch is in the pictures of a camera that has moved: its own pixels by way of the plane of the
/// tags.
WhitePatch relocated(const WhitePatch& patch, const CameraModel& before, const CameraModel& now,
                     double plane_mm);
FixedPoint relocated(const FixedPoint& point, const CameraModel& before, const CameraModel& now,
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
  std::vector<PointSighting> points = {};
};

/// Tags of the calibration's kinds, its fixed points, and what its white patches read. Where tags and points
/// say that the camera and the table moved to each other, the patches are looked for where they are now.
Result<RigSightings> sightings_in(const Calibration& calibration, const solve::Photographs& photographs);

/// The same as evidence for or against a calibration, whose patches are paired with what was read inside
/// them: another one than the photographs were taken with may have others. Points are paired by their ids.
/// Up to a third of them, which are where no move of the camera puts them, are left out: they are taken for
/// something else that looks like them. So are all where no tag is in sight and they are less than four, or
/// nearly in a line.
RigEvidence evidence_of(const Calibration& calibration, const RigSightings& sightings);

}  // namespace weft::calibration
