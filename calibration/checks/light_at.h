// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "core/image.h"
#include "core/lights.h"
#include "core/vec.h"

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

/// Coordinates in [-1, 1] that log gains are functions of, as core/light_field.h has them.
inline std::array<double, 2> gain_place(Size frame, double x_px, double y_px) {
  return {2 * x_px / std::fmax(frame.width - 1, 1) - 1, 2 * y_px / std::fmax(frame.height - 1, 1) - 1};
}

}  // namespace weft::calibration
