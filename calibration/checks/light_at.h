// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "core/base/vec.h"
#include "core/rig/lights.h"

namespace weft::calibration {

/// A near light at a point in the rig frame, seen by a pixel.
struct LightAt {
  Vec3 direction;           ///< l: unit, from the point to the LED
  double log_geometry = 0;  ///< ln of max(0, -l . aim)^mu / d^2
};

/// Nothing behind the LED.
inline std::optional<LightAt> light_at(const NearLight& led, Vec3 point_mm) {
  const Vec3 to_led = led.position_mm - point_mm;
  const double distance_mm = length(to_led);
  const Vec3 l = (1 / distance_mm) * to_led;
  const double lobe = -dot(l, led.aim);
  if (!(lobe > 0)) return std::nullopt;
  return LightAt{l, led.mu * std::log(lobe) - 2 * std::log(distance_mm)};
}

}  // namespace weft::calibration
