// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/rig/camera.h"

namespace weft {

/// Where the photosites of one colour look, against those of green: one that lies d from the principal point
/// looks where a green one at d (1 + scale + cubic r^2) does, r being d over the focal length. The radial
/// terms of Mallon and Whelan, Pattern Recognition Letters 28 (2007).
struct RadialShift {
  double scale = 0, cubic = 0;
  double sigma_scale = 0, sigma_cubic = 0;  ///< standard deviations; 0 of a term that was not fitted

  friend bool operator==(const RadialShift&, const RadialShift&) = default;
};

/// Lateral colour of a lens: it shows red and blue at other scales than green, which `CameraModel` is of.
struct LateralColor {
  RadialShift red, blue;

  /// The shift of a channel: 0 red, 1 green, 2 blue.
  RadialShift of(std::size_t channel) const {
    return channel == 0 ? red : channel == 2 ? blue : RadialShift();
  }
  friend bool operator==(const LateralColor&, const LateralColor&) = default;
};

/// How much farther right and down than a green photosite at (x, y) one of another colour looks, pixels.
std::array<double, 2> shift_at(const RadialShift& shift, const CameraModel& camera, double x, double y);

/// How much farther from the principal point it looks in the frame's farthest corner, pixels.
double shift_at_corner(const RadialShift& shift, const CameraModel& camera);

}  // namespace weft
