// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/calib3d.hpp>

#include "calibration/camera/pose.h"
#include "core/rig/camera.h"

// A CameraModel as OpenCV takes it.

namespace weft::calibration {

inline cv::Matx33d camera_matrix(const CameraModel& c) {
  return {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
}

inline cv::Vec<double, 5> distortion(const CameraModel& c) {
  return {c.k1, c.k2, c.p1, c.p2, c.k3};
}

/// The pose of a body in the camera's frame.
inline Pose pose_of(const cv::Mat& turn, const cv::Mat& shift) {
  const auto* w = turn.ptr<double>();
  const auto* t = shift.ptr<double>();
  return {rotation_of({w[0], w[1], w[2]}), {t[0], t[1], t[2]}};
}

}  // namespace weft::calibration
