// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/sheet_lay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/camera/finder.h"
#include "calibration/guide/pose_words.h"

namespace weft::calibration {
namespace {

constexpr double kFlat_deg = 4;      // a sheet that is asked to be tilted is not, below
constexpr double kTurned_deg = 60;   // of the quarter that was asked
constexpr double kOffMiddle = 0.2;   // of the shorter side of what the camera sees of the table
constexpr double kSideOff_deg = 30;  // another edge is raised
constexpr double kWholeTurn_deg = 360;

/// The table as it lies in the picture.
struct PictureFrame {
  Vec3 middle_mm;
  double right_deg = 0;  ///< from x towards y
  double shorter_mm = 0;
};

PictureFrame frame_of(const CameraModel& camera) {
  const double right = camera.size.width - 1, bottom = camera.size.height - 1;
  const auto at = [&](double x, double y) { return point_on_plane(camera, x, y, 0); };
  const Vec3 across = at(right, bottom / 2) - at(0, bottom / 2),
             down = at(right / 2, bottom) - at(right / 2, 0);
  return {at(right / 2, bottom / 2), degrees(std::atan2(across.y, across.x)),
          std::min(length(across), length(down))};
}

std::array<Vec3, 4> corners_of(const Pose& rig_from_sheet, const Sheet& sheet) {
  const double u = sheet.width_mm / 2, v = sheet.height_mm / 2;
  return {rig_from_sheet({-u, v, 0}), rig_from_sheet({u, v, 0}), rig_from_sheet({u, -v, 0}),
          rig_from_sheet({-u, -v, 0})};
}

Vec3 wanted_normal(const WantedLay& wanted, double azimuth_deg) {
  const double tilt = radians(wanted.tilt_deg), azimuth = radians(azimuth_deg);
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

std::string raised_edge(const SheetLay& lay, const CameraModel& camera) {
  const auto seen = [&](Vec3 p) {
    const Vec3 px = project(camera, p);
    return PixelPoint{px.x, px.y};
  };
  const Vec3 towards = lay.centre_mm - Vec3{lay.normal.x, lay.normal.y, 0};
  return edge_towards(seen(lay.centre_mm), seen({towards.x, towards.y, lay.centre_mm.z}));
}

std::string flat_departure(const SheetLay& lay, double tilt_deg, const SheetAim& aim) {
  const WantedLay& wanted = aim.wanted;
  if (tilt_deg > wanted.within_deg) {
    return fmt::format("the sheet is tilted by {:.0f} degrees, its {} raised: lay it flat", tilt_deg,
                       raised_edge(lay, aim.camera));
  }
  if (lay.lowest_mm > wanted.within_mm)
    return fmt::format("the sheet lies {:.0f} mm above the table: lay it down on it", lay.lowest_mm);
  if (wanted.is_turned) {
    double least_deg = kWholeTurn_deg;
    for (const double before_deg : aim.turns_deg)
      least_deg = std::min(least_deg, between_deg(lay.turn_deg, before_deg));
    if (least_deg < kTurned_deg) {
      return least_deg < kFlat_deg
                 ? "the sheet lies turned as before: turn it by 90 degrees"
                 : fmt::format("the sheet is turned by {:.0f} degrees: turn it by 90 degrees", least_deg);
    }
  }
  if (!wanted.is_in_middle) return "";
  const PictureFrame frame = frame_of(aim.camera);
  const double off_mm = std::hypot(lay.centre_mm.x - frame.middle_mm.x, lay.centre_mm.y - frame.middle_mm.y);
  if (off_mm <= kOffMiddle * frame.shorter_mm) return "";
  return fmt::format("the sheet lies {:.0f} mm from the middle of the picture: move it there", off_mm);
}

std::string tilted_departure(const SheetLay& lay, double tilt_deg, const SheetAim& aim) {
  const WantedLay& wanted = aim.wanted;
  const bool is_any_side = *wanted.raised == 0;
  const std::string edge = is_any_side ? "an edge" : fmt::format("its {}", wanted.raised);
  if (tilt_deg < kFlat_deg) return fmt::format("the sheet lies flat: raise {}", edge);
  const double azimuth_deg = wanted.azimuth_deg + frame_of(aim.camera).right_deg;
  const double off_deg = is_any_side ? std::abs(tilt_deg - wanted.tilt_deg)
                                     : angle_deg(lay.normal, wanted_normal(wanted, azimuth_deg));
  if (off_deg <= wanted.within_deg) return "";
  const double leans_deg = degrees(std::atan2(lay.normal.y, lay.normal.x));
  if (!is_any_side && between_deg(leans_deg, azimuth_deg) > kSideOff_deg)
    return fmt::format("the sheet's {} is raised: raise {}", raised_edge(lay, aim.camera), edge);
  return fmt::format("the sheet is tilted by {:.0f} degrees: tilt it by {:.0f}", tilt_deg, wanted.tilt_deg);
}

}  // namespace

double between_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, kWholeTurn_deg));
}

SheetLay lay_of(const Pose& rig_from_sheet, const Sheet& sheet) {
  SheetLay lay = {normal_of(rig_from_sheet), turn_deg(rig_from_sheet), rig_from_sheet.translation_mm, 0};
  const std::array<Vec3, 4> corners = corners_of(rig_from_sheet, sheet);
  lay.lowest_mm = std::ranges::min_element(corners, {}, &Vec3::z)->z;
  return lay;
}

std::string departure_of(const SheetLay& lay, const SheetAim& aim) {
  const double tilt_deg = angle_deg(lay.normal, {0, 0, 1});
  return aim.wanted.tilt_deg > 0 ? tilted_departure(lay, tilt_deg, aim) : flat_departure(lay, tilt_deg, aim);
}

std::array<PixelPoint, 4> outline_of(const Pose& rig_from_sheet, const Sheet& sheet,
                                     const CameraModel& camera) {
  std::array<PixelPoint, 4> outline;
  std::ranges::transform(corners_of(rig_from_sheet, sheet), outline.begin(), [&](Vec3 corner) {
    const Vec3 px = project(camera, corner);
    return share_of({px.x, px.y}, camera.size);
  });
  return outline;
}

std::array<PixelPoint, 4> outline_of(const SheetAim& aim) {
  const PictureFrame frame = frame_of(aim.camera);
  const double azimuth = radians(aim.wanted.azimuth_deg + frame.right_deg);
  const double before_deg = aim.turns_deg.empty() ? frame.right_deg : aim.turns_deg.back();
  const double turn = radians(before_deg + (aim.wanted.is_turned ? 90 : 0));
  const Mat3 tilted =
      rotation_of(radians(aim.wanted.tilt_deg) * Vec3{-std::sin(azimuth), std::cos(azimuth), 0});
  Pose pose = {product(tilted, rotation_of({0, 0, turn})), {}};
  pose.translation_mm = frame.middle_mm + Vec3{0, 0, -lay_of(pose, aim.sheet.sheet).lowest_mm};
  return outline_of(pose, aim.sheet.sheet, aim.camera);
}

}  // namespace weft::calibration
