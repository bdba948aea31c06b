// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/cloth.h"

#include <algorithm>
#include <cmath>

#include "simulator/reflectance/fresnel.h"

namespace weft::simulator {
namespace {

double spread(const Cloth& cloth) {
  return std::max(kSmallestAlpha, cloth.alpha);
}

}  // namespace

double Cloth::distribution(Vec3 h) const {
  const double a2 = spread(*this) * spread(*this);
  constexpr double kUpright = 1e-12;  // exp(-cot^2) is 0 well before sin^2 is
  const double cot2 = h.z * h.z / std::max(h.x * h.x + h.y * h.y, kUpright);
  const double fuzz = amplitude * std::exp(-cot2 / a2) * (1 + cot2) * (1 + cot2);
  return (1 + fuzz) / (kPi * (1 + amplitude * a2));
}

Rgb Cloth::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const Facet facet = facet_between(l, v);
  constexpr double kGrazing = 1e-4;
  const double n_v = std::max(0.0, v.z);
  const double lobe = distribution(facet.normal) / (4 * std::max(l.z + n_v - l.z * n_v, kGrazing));
  return lobe_over_diffuse(lobe, f0, Beneath::kBalanced, albedo, {l.z, n_v, facet.cosine});
}

DirectionSample Cloth::sample(Vec3 v, double u1, double u2) const {
  const Vec3 l = cosine_or_lobe(u1, u2, [&](double a, double b) {
    const double a2 = spread(*this) * spread(*this);
    const double offset = 1 / (1 + amplitude * a2);  // its share of the facets
    if (a < offset) return mirrored(v, cosine_direction(a / offset, b));
    const double cot2 = -a2 * std::log((1 - a) / (1 - offset));
    return mirrored(v, from_cosine(std::sqrt(cot2 / (1 + cot2)), b));
  });
  return {l, density(l, v)};
}

double Cloth::density(Vec3 l, Vec3 v) const {
  return cosine_or_lobe_density(l, mirrored_density(l, v, [&](Vec3 h) { return distribution(h); }));
}

}  // namespace weft::simulator
