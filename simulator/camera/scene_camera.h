// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/rig/camera.h"
#include "simulator/camera/camera_settings.h"

namespace weft::simulator {

/// The camera that looks at (x_mm, y_mm, 0) of the table from `distance_mm`, with `mm_per_pixel` there. A
/// tilted camera is the upright one turned about a level axis through that point, so that any azimuth without
/// tilt is the camera straight above. kBadData as check_camera.
Result<CameraModel> camera_of(Size size, double distance_mm, double mm_per_pixel, const LensSettings& lens,
                              const PoseSettings& pose, double height_mm);

/// kBadData where the lens folds the picture within the frame or kRayMargin pixels beyond it, or where a ray
/// of the frame's edge does not meet the plane z = height_mm from above, at more than a degree.
Result<void> check_camera(const CameraModel& camera, double height_mm);

/// Blur and bloom ask for rays up to this far outside the frame, pixels.
inline constexpr int kRayMargin = 128;

/// What a pixel sees lies on this, in the rig frame.
struct CameraRay {
  Vec3 origin_mm;
  Vec3 direction;  ///< unit, from the camera
};

/// A place in the picture; (0, 0) is the centre of the top left photosite.
struct PicturePoint {
  double x_px;
  double y_px;
  double depth_mm;  ///< along the optical axis
};

/// A CameraModel made ready: distortion as Brown (1966) in the form of OpenCV, which is the gradient of a
/// function: with q = (p2, p1),  f(p) = L(p.p) p + (p.p) q + 2 (q.p) p. Where that function is convex f has
/// one inverse; it is found by Newton's method to a residual of 1e-14 of a focal length. A lens without
/// distortion inverts nothing.
class Lens {
 public:
  /// kBadData where the lens folds the picture: where f is not certain to stretch by at least 1/20 on a
  /// disc that holds the frame and kRayMargin. The bound is sharp for radial distortion, and up to
  /// 12 |q| r too careful for tangential.
  static Result<Lens> of(const CameraModel& camera);

  CameraRay ray(double x, double y) const;
  /// Where the ray of a pixel meets the plane z = height_mm; the camera must pass check_camera.
  Vec3 point_on_plane(double x, double y, double height_mm) const;
  /// Nothing for a point behind the camera or so far outside the frame that the lens might fold it in.
  std::optional<PicturePoint> picture_point(Vec3 point_mm) const;

 private:
  struct Point {
    double x, y;
  };
  struct Distorted {
    Point at;
    double xx, xy, yy;  ///< Jacobian, symmetric
  };
  explicit Lens(const CameraModel& camera);
  double least_stretch(double radius) const;
  Distorted distorted(Point ideal) const;
  Point undistorted(Point seen) const;
  Vec3 towards(double x, double y) const;

  CameraModel camera_;
  Vec3 centre_mm_;
  bool is_distorted_;
  double ideal_radius_;  ///< of the disc that holds the frame on the ideal image plane
};

}  // namespace weft::simulator
