// SPDX-License-Identifier: Apache-2.0
#include "simulator/light/incidence.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {
namespace {

constexpr double kNearest_mm = 1;
constexpr double kWidestSine = 0.999;  // of a sphere that the point is not inside

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
  return {direction, lobe > 0 ? power(lobe, led.mu) / (d * d) : 0, d};
}

double sphere_cosine(double cosine, double sine) {
  sine = std::min(sine, kWidestSine);
  if (cosine >= sine) return cosine;
  if (cosine <= -sine) return 0;
  const double across = std::sqrt(1 - cosine * cosine);
  const double x = std::sqrt(1 / (sine * sine) - 1);
  const double y = std::clamp(-x * cosine / across, -1.0, 1.0);
  const double root = across * std::sqrt(1 - y * y);
  const double share = (cosine * std::acos(y) - x * root) + std::atan(root / x) / (sine * sine);
  return std::max(share / kPi, 0.0);
}

}  // namespace weft::simulator
