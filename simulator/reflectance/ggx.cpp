// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/ggx.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {

GgxLobe::GgxLobe(double alpha_x, double alpha_y)
    : alpha_x_(std::max(kSmallestAlpha, alpha_x)), alpha_y_(std::max(kSmallestAlpha, alpha_y)) {}

double GgxLobe::distribution(Vec3 h) const {
  const double x = h.x / alpha_x_, y = h.y / alpha_y_;
  const double stretched = x * x + y * y + h.z * h.z;
  return 1 / (kPi * alpha_x_ * alpha_y_ * stretched * stretched);
}

double GgxLobe::visibility(Vec3 direction) const {
  const double x = alpha_x_ * direction.x, y = alpha_y_ * direction.y, z = direction.z;
  return 1 / (z + std::sqrt(x * x + y * y + z * z));
}

double GgxLobe::evaluate(Vec3 l, Vec3 v, const Facet& facet) const {
  return distribution(facet.normal) * visibility(l) * visibility(above_horizon(v));
}

Vec3 GgxLobe::sample(Vec3 to_view, double u1, double u2) const {
  const Vec3 v = above_horizon(to_view);
  // Stretched until they are a hemisphere, the facets seen are a cap around the view, displaced by it.
  const Vec3 stretched = normalized({alpha_x_ * v.x, alpha_y_ * v.y, v.z});
  const Vec3 cap = from_cosine((1 - u1) * (1 + stretched.z) - stretched.z, u2) + stretched;
  return mirrored(v, normalized({alpha_x_ * cap.x, alpha_y_ * cap.y, std::max(1e-12, cap.z)}));
}

double GgxLobe::density(Vec3 l, Vec3 to_view) const {
  const Vec3 v = above_horizon(to_view);
  if (l.z + v.z <= 0) return 0;
  return distribution(facet_between(l, v).normal) * visibility(v) / 2;
}

Rgb Ggx::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const Facet facet = facet_between(l, v);
  return lobe_over_diffuse(GgxLobe(alpha, alpha).evaluate(l, v, facet), f0, beneath, albedo,
                           {l.z, std::max(0.0, v.z), facet.cosine});
}

DirectionSample Ggx::sample(Vec3 v, double u1, double u2) const {
  const Vec3 l =
      cosine_or_lobe(u1, u2, [&](double a, double b) { return GgxLobe(alpha, alpha).sample(v, a, b); });
  return {l, density(l, v)};
}

double Ggx::density(Vec3 l, Vec3 v) const {
  return cosine_or_lobe_density(l, GgxLobe(alpha, alpha).density(l, v));
}

}  // namespace weft::simulator
