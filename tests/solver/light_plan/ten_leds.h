// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "solver/light_plan/light_plan.h"

// Four LEDs at 35 degrees from the zenith and six at 62, 600 mm from a cloth.

namespace weft::solver {

inline NearLight led_from(double zenith_deg, double azimuth_deg) {
  const double zenith = radians(zenith_deg), azimuth = radians(azimuth_deg);
  const Vec3 l = {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth),
                  std::cos(zenith)};
  NearLight led;
  led.position_mm = 600.0 * l;
  led.aim = -1.0 * l;
  return led;
}

inline ForeseenRig rig_with(std::vector<NearLight> leds) {
  ForeseenRig rig;
  rig.leds = std::move(leds);
  rig.led_covariance = typical_led_covariance(rig.leds, rig.places_mm.front());
  return rig;
}

inline ForeseenRig ten_leds() {
  std::vector<NearLight> leds;
  for (int k = 0; k < 10; ++k) leds.push_back(k < 4 ? led_from(35, 90 * k) : led_from(62, 60 * (k - 4) + 15));
  return rig_with(leds);
}

/// The same, of a frame of 180 x 120 mm.
inline ForeseenRig ten_leds_over_a_frame() {
  ForeseenRig rig = ten_leds();
  for (const double x : {-90.0, 0.0, 90.0}) {
    for (const double y : {-60.0, 0.0, 60.0}) {
      if (x != 0 || y != 0) rig.places_mm.push_back({x, y, 0});
    }
  }
  return rig;
}

inline Lobe ggx_of(double alpha, double f0) {
  return {.family = LobeFamily::kGgx, .alpha = alpha, .f0 = f0};
}

}  // namespace weft::solver
