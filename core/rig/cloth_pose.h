// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

namespace weft {

/// How a cloth lies that does not lie flat on the table: on a wedge, tilted about the point of the z axis at
/// its height, and not turned.
struct ClothPose {
  double tilt_deg = 0;      ///< between the cloth and the table, 0 to kMostTilt_deg
  double downhill_deg = 0;  ///< azimuth to which it falls, from x towards y

  bool is_level() const { return tilt_deg == 0; }
  friend bool operator==(const ClothPose&, const ClothPose&) = default;
};
inline constexpr double kMostTilt_deg = 45;

/// Turns the axes of the cloth, whose z is its normal, into those of the rig.
Mat3 rig_from_cloth(const ClothPose& pose);

/// What a tilted cloth sees if it is taken to be level: the rig turned about it. `height_mm` is the cloth's
/// on the z axis.
Vec3 seen_from(const ClothPose& pose, double height_mm, Vec3 point_in_rig_mm);
CameraModel seen_from(const ClothPose& pose, double height_mm, CameraModel camera);
Lights seen_from(const ClothPose& pose, double height_mm, Lights lights);
/// Turns parameters named NAME.x, NAME.y and NAME.z, which are there together; the others are numbers that no
/// turn changes.
ParameterCovariance seen_from(const ClothPose& pose, ParameterCovariance covariance);

}  // namespace weft
