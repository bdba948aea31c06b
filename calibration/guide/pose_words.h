// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calibration/camera/guidance.h"

namespace weft::calibration {

/// "tilt the board by 30 degrees, raising its left edge, at the upper right of the picture": what a person
/// does who looks at the camera's picture.
std::string words_of(const BoardPose& pose, const CameraModel& camera);

/// The edge or corner of a thing in a picture that lies that way from its centre: "left edge".
std::string edge_towards(PixelPoint from, PixelPoint to);

}  // namespace weft::calibration
