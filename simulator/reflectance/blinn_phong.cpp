// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/blinn_phong.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {

double BlinnPhong::power() const {
  return std::exp2(13 * gloss);
}

double BlinnPhong::distribution(Vec3 h) const {
  const double m = power();
  return (m + 2) / (2 * kPi) * std::pow(h.z, m);
}

Rgb BlinnPhong::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const Facet facet = facet_between(l, v);
  const double n_v = std::max(0.0, v.z);
  const double a = 1 / std::sqrt(kPi / 4 * power() + kPi / 2);
  const double visibility = 1 / ((l.z * (1 - a) + a) * (n_v * (1 - a) + a));
  return lobe_over_diffuse(distribution(facet.normal) / 4 * visibility, f0, beneath, albedo,
                           {l.z, n_v, facet.cosine});
}

DirectionSample BlinnPhong::sample(Vec3 v, double u1, double u2) const {
  const Vec3 l = cosine_or_lobe(u1, u2, [&](double a, double b) {
    return mirrored(v, from_cosine(std::pow(1 - a, 1 / (power() + 2)), b));
  });
  return {l, density(l, v)};
}

double BlinnPhong::density(Vec3 l, Vec3 v) const {
  return cosine_or_lobe_density(l, mirrored_density(l, v, [&](Vec3 h) { return distribution(h); }));
}

}  // namespace weft::simulator
