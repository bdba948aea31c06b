// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/beckmann.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {

double Beckmann::distribution(Vec3 h) const {
  const double m = std::max(kSmallestAlpha, alpha);
  constexpr double kHorizon = 1e-12;  // exp(-tan^2) is 0 well before cos^2 is
  const double tan2 = (h.x * h.x + h.y * h.y) / std::max(h.z * h.z, kHorizon);
  return std::exp(-tan2 / (m * m)) * (1 + tan2) * (1 + tan2) / (kPi * m * m);
}

double Beckmann::shadowing_over_cosine(double cosine) const {
  const double m_sine = std::max(kSmallestAlpha, alpha) * std::sqrt(std::max(0.0, 1 - cosine * cosine));
  if (cosine >= 1.6 * m_sine) return 1 / cosine;
  const double a = cosine / m_sine;
  const double fit = (3.535 + 2.181 * a) / ((1 + 2.276 * a + 2.577 * a * a) * m_sine);
  return fit * cosine < 1 ? fit : 1 / cosine;
}

Rgb Beckmann::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const Facet facet = facet_between(l, v);
  const double n_v = std::max(0.0, v.z);
  const double lobe =
      distribution(facet.normal) * shadowing_over_cosine(l.z) * shadowing_over_cosine(n_v) / 4;
  return lobe_over_diffuse(lobe, f0, beneath, albedo, {l.z, n_v, facet.cosine});
}

DirectionSample Beckmann::sample(Vec3 v, double u1, double u2) const {
  const Vec3 l = cosine_or_lobe(u1, u2, [&](double a, double b) {
    const double m = std::max(kSmallestAlpha, alpha);
    return mirrored(v, from_cosine(1 / std::sqrt(1 - m * m * std::log(1 - a)), b));
  });
  return {l, density(l, v)};
}

double Beckmann::density(Vec3 l, Vec3 v) const {
  return cosine_or_lobe_density(l, mirrored_density(l, v, [&](Vec3 h) { return distribution(h); }));
}

}  // namespace weft::simulator
