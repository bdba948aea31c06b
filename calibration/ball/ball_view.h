// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "calibration/ball/outline.h"
#include "core/base/vec.h"

// A ball as a camera sees it: x right, y up, z to the camera.

namespace weft::calibration {

/// A place on a ball: its normal there, and the direction to the camera.
struct BallPoint {
  Vec3 normal, to_camera;
};

/// Pixels of one ball into places on it. With a focal length the outline is the cone of rays that touch the
/// ball; without one the camera is infinitely far away, and every ray is along z.
class BallView {
 public:
  /// `focal_px` 0: not known. The optical axis is in the middle of the picture.
  BallView(const Outline& outline, Size picture, double focal_px);

  /// Nothing beside the ball.
  std::optional<BallPoint> at(double x, double y) const;

  /// Its centre for a radius in mm. Origin: with a focal length the camera; without one the middle of the
  /// picture at the height of the ball's centre.
  Vec3 centre_mm(double radius_mm) const;

  const Circle& circle() const { return circle_; }

 private:
  Vec3 ray(double x, double y) const;  ///< unit, from the camera

  Circle circle_;
  Size picture_;
  double focal_px_;
  Vec3 axis_;        ///< from the camera to the centre, unit
  double sine_ = 0;  ///< radius over distance
};

}  // namespace weft::calibration
