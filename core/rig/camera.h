// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/image.h"

namespace weft {

/// Pinhole camera with Brown-Conrady distortion (Brown 1966, as in OpenCV). Pixel (0, 0) is the centre of the
/// top left photosite of the active area. Camera frame: x right, y down, z from the camera to the scene.
struct CameraModel {
  Size size;
  double fx = 0, fy = 0;  ///< focal length, pixels
  double cx = 0, cy = 0;  ///< principal point, pixels
  double k1 = 0, k2 = 0, k3 = 0, p1 = 0, p2 = 0;
  Mat3 camera_from_rig_rotation = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
  Vec3 camera_from_rig_translation_mm;

  friend bool operator==(const CameraModel&, const CameraModel&) = default;
};

/// A camera straight above the table at `distance_mm`, seeing `mm_per_pixel` at z = 0, without distortion.
CameraModel overhead_camera(Size size, double distance_mm, double mm_per_pixel);

/// The centre of its lens in the rig frame, mm.
Vec3 centre_of(const CameraModel& camera);

/// Where the ray of pixel (x, y) meets the plane z = `height_mm` of the rig frame. Distortion is inverted by
/// Newton's method to 1e-12 of a focal length.
Vec3 point_on_plane(const CameraModel& camera, double x, double y, double height_mm);

/// Pixel of a point of the rig frame: {x, y, depth_mm}.
Vec3 project(const CameraModel& camera, Vec3 point_in_rig_mm);

}  // namespace weft
