// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/representative_point.h"

#include <algorithm>
#include <cmath>

#include "simulator/reflectance/ggx.h"

namespace weft::simulator {

double widened_alpha(double alpha, double radius_mm, double distance_mm) {
  const double half_angle = radius_mm / (2 * distance_mm);
  return std::min(1.0, std::sqrt(alpha * alpha + half_angle * half_angle));
}

Rgb representative_point(const SphericalLight& light, Vec3 v, double roughness, const Rgb& f0) {
  const Vec3 centre = light.centre_mm;
  const double distance_mm = length(centre);
  if (!(centre.z > 0) || !(distance_mm > light.radius_mm)) return {};

  const Vec3 r = mirrored(v, {0, 0, 1});
  const Vec3 centre_to_ray = dot(centre, r) * r - centre;
  const double off_ray_mm = length(centre_to_ray);
  const double share = off_ray_mm > light.radius_mm ? light.radius_mm / off_ray_mm : 1;
  const Vec3 l = normalized(centre + share * centre_to_ray);
  if (!(l.z > 0)) return {};

  const double alpha = std::max(kSmallestAlpha, roughness);
  const double narrowing = alpha / std::min(1.0, alpha + light.radius_mm / (3 * distance_mm));
  const Facet facet = facet_between(l, v);
  const double lobe = narrowing * narrowing * GgxLobe(alpha, alpha).evaluate(l, v, facet);
  return lobe_over_diffuse(l.z * lobe, f0, Beneath::kLambert, {}, {l.z, std::max(0.0, v.z), facet.cosine});
}

}  // namespace weft::simulator
