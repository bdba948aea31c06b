// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/directions.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {

Vec3 above_horizon(Vec3 direction) {
  if (direction.z >= 0) return direction;
  const double across = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  return across > 0 ? Vec3{direction.x / across, direction.y / across, 0} : Vec3{1, 0, 0};
}

Facet facet_between(Vec3 l, Vec3 v) {
  const Vec3 sum = l + v;
  const double twice_cosine = std::sqrt(dot(sum, sum));
  if (twice_cosine == 0) return {{1, 0, 0}, 0};
  return {above_horizon((1 / twice_cosine) * sum), std::min(twice_cosine / 2, 1.0)};
}

Vec3 mirrored(Vec3 v, Vec3 h) {
  return 2 * dot(v, h) * h - v;
}

Vec3 from_cosine(double cosine, double turn) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::cos(2 * kPi * turn), sine * std::sin(2 * kPi * turn), cosine};
}

Vec3 cosine_direction(double u1, double u2) {
  return from_cosine(std::sqrt(1 - u1), u2);
}

double cosine_density(Vec3 direction) {
  return std::max(0.0, direction.z) / kPi;
}

}  // namespace weft::simulator
