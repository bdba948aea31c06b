// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/sheet.h"

#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

bool is_paper(const Sheet& sheet, double u_mm, double v_mm) {
  if (std::abs(u_mm) > sheet.width_mm / 2 - sheet.margin_mm) return false;
  if (std::abs(v_mm) > sheet.height_mm / 2 - sheet.margin_mm) return false;
  return std::none_of(sheet.printed.begin(), sheet.printed.end(), [&](const PrintedSquare& p) {
    return std::max(std::abs(u_mm - p.u_mm), std::abs(v_mm - p.v_mm)) < p.side_mm / 2;
  });
}

}  // namespace

LineOfSight sight_of(const CameraModel& camera, double x_px, double y_px) {
  const Pose rig_from_camera =
      inverse({camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm});
  const Vec3 centre = rig_from_camera.translation_mm;
  return {centre, point_on_plane(camera, x_px, y_px, 0) - centre};
}

std::optional<Vec3> point_on_sheet(const LineOfSight& sight, const Pose& rig_from_sheet) {
  const Vec3 n = normal_of(rig_from_sheet);
  const double towards = dot(n, sight.direction);
  if (!(towards < 0)) return {};
  const double t = dot(n, rig_from_sheet.translation_mm - sight.origin_mm) / towards;
  if (!(t > 0) || !std::isfinite(t)) return {};
  return sight.origin_mm + t * sight.direction;
}

bool shows_paper(const CameraModel& camera, const Sheet& sheet, const Pose& rig_from_sheet, double x_px,
                 double y_px, double side_px) {
  for (const double dy : {-0.5, 0.0, 0.5}) {
    for (const double dx : {-0.5, 0.0, 0.5}) {
      const auto point =
          point_on_sheet(sight_of(camera, x_px + dx * side_px, y_px + dy * side_px), rig_from_sheet);
      if (!point) return false;
      const Vec3 on = *point - rig_from_sheet.translation_mm;
      if (!is_paper(sheet, dot(on, u_axis(rig_from_sheet)), dot(on, v_axis(rig_from_sheet)))) return false;
    }
  }
  return true;
}

bool same_pose(const Pose& a, const Pose& b) {
  return angle_deg(normal_of(a), normal_of(b)) < 0.5 && angle_deg(u_axis(a), u_axis(b)) < 2 &&
         length(a.translation_mm - b.translation_mm) < 1;
}

}  // namespace weft::calibration
