// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "calibration/camera/spread.h"
#include "core/rig/camera.h"
#include "core/rig/lateral_color.h"

namespace weft::calibration {

/// What the edges of a board say of a lens's lateral colour.
struct LateralFit {
  /// Nothing where neither red nor blue looks elsewhere than green.
  std::optional<LateralColor> color;
  std::array<double, 2> corner_px = {};  ///< of red and blue, as shift_at_corner(); 0 where it is noise
  std::array<double, 2> sigma_corner_px = {};
};

/// Fits where red and blue photosites look against green ones to how far their edges lie apart, by least
/// squares over the edges within four standard deviations of the others. Each colour is seen through its own
/// photosites alone. The cubic term is fitted where it is over three of its standard deviations. A colour is
/// taken to look where green does where noise alone does as much once in a thousand, or where it is nowhere
/// 0.05 pixel aside. Nothing where either colour shares fewer than 40 edges with green.
std::optional<LateralFit> fit_lateral_color(std::span<const BoardEdge> edges, const CameraModel& camera);

}  // namespace weft::calibration
