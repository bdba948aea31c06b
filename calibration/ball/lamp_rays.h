// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/base/vec.h"

namespace weft::calibration {

/// From a ball towards a lamp.
struct LampRay {
  Vec3 origin_mm;
  Vec3 direction;  ///< unit
  double sigma_deg = 0;
};

/// Where rays of several balls meet, and the standard deviation of that along its worst axis.
struct LampPlace {
  Vec3 position_mm;
  double sigma_mm = 0;
};

/// Least squares of the distances to the rays over their sigma there. Nothing for fewer than two rays, for
/// rays that are parallel or part, and where sigma is over half the distance.
std::optional<LampPlace> meeting_of(std::span<const LampRay> rays);

}  // namespace weft::calibration
