// SPDX-License-Identifier: Apache-2.0
#include "simulator/light.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {
namespace {

constexpr double kNearest_mm = 1;

double power(double base, double exponent) {
  if (exponent == 0) return 1;
  return exponent == 1 ? base : std::pow(base, exponent);
}

}  // namespace

Incidence incidence(const NearLight& led, Vec3 point_mm) {
  const Vec3 to_led = led.position_mm - point_mm;
  const double d = std::max(std::sqrt(dot(to_led, to_led)), kNearest_mm);
  const Vec3 direction = (1 / d) * to_led;
  const double lobe = -dot(direction, led.aim);
  return {direction, lobe > 0 ? power(lobe, led.mu) / (d * d) : 0};
}

}  // namespace weft::simulator
