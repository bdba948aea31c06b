// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "calibration/camera/pose.h"
#include "core/base/vec.h"
#include "core/rig/camera.h"

namespace weft::calibration {

/// A square printed on a sheet, such as a tag: no paper there.
struct PrintedSquare {
  double u_mm = 0, v_mm = 0;  ///< its centre, from the centre of the sheet
  double side_mm = 0;         ///< with its quiet zone
};

/// A flat sheet of white paper. Its frame: origin at its centre, u right, v up, the normal towards the
/// reader.
struct Sheet {
  double width_mm = 297;
  double height_mm = 210;
  double margin_mm = 5;  ///< width of the border that is not used
  std::vector<PrintedSquare> printed;
  /// Diffuse reflectance at normal incidence, where it was measured; else readings speak of the paper as 1.
  std::optional<std::array<double, 3>> reflectance_rgb;
};

/// The axes of a sheet in the rig frame.
inline Vec3 u_axis(const Pose& rig_from_sheet) {
  return rig_from_sheet.rotation * Vec3{1, 0, 0};
}
inline Vec3 v_axis(const Pose& rig_from_sheet) {
  return rig_from_sheet.rotation * Vec3{0, 1, 0};
}
inline Vec3 normal_of(const Pose& rig_from_sheet) {
  return rig_from_sheet.rotation * Vec3{0, 0, 1};
}

/// How a sheet is turned: its u axis, from x towards y, degrees.
inline double turn_deg(const Pose& rig_from_sheet) {
  const Vec3 u = u_axis(rig_from_sheet);
  return degrees(std::atan2(u.y, u.x));
}

/// A line of sight in the rig frame.
struct LineOfSight {
  Vec3 origin_mm;
  Vec3 direction;  ///< of any length
};
LineOfSight sight_of(const CameraModel& camera, double x_px, double y_px);

/// Where a line of sight meets the plane of a sheet; nothing where it passes it by or sees its back.
std::optional<Vec3> point_on_sheet(const LineOfSight& sight, const Pose& rig_from_sheet);

/// Whether the whole pixel square of `side_px` about (x_px, y_px) shows paper: inside the margin, beside what
/// is printed.
bool shows_paper(const CameraModel& camera, const Sheet& sheet, const Pose& rig_from_sheet, double x_px,
                 double y_px, double side_px);

/// Whether two captures show a sheet in one pose: its normal within 0.5 degrees, its turn within 2 and its
/// centre within 1 mm.
bool same_pose(const Pose& a, const Pose& b);

}  // namespace weft::calibration
