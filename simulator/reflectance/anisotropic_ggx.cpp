// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/anisotropic_ggx.h"

#include <algorithm>

namespace weft::simulator {

Rgb AnisotropicGgx::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const Facet facet = facet_between(l, v);
  return lobe_over_diffuse(lobe().evaluate(l, v, facet), f0, beneath, albedo,
                           {l.z, std::max(0.0, v.z), facet.cosine});
}

DirectionSample AnisotropicGgx::sample(Vec3 v, double u1, double u2) const {
  const Vec3 l = cosine_or_lobe(u1, u2, [&](double a, double b) { return lobe().sample(v, a, b); });
  return {l, density(l, v)};
}

double AnisotropicGgx::density(Vec3 l, Vec3 v) const {
  return cosine_or_lobe_density(l, lobe().density(l, v));
}

}  // namespace weft::simulator
