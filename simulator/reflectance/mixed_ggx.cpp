// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/mixed_ggx.h"

#include <algorithm>

namespace weft::simulator {

Rgb MixedGgx::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const Facet facet = facet_between(l, v);
  const auto lobe = [&](double roughness) { return GgxLobe(roughness, roughness).evaluate(l, v, facet); };
  const double mixed = (1 - second_share) * lobe(alpha) + second_share * lobe(second_alpha);
  return lobe_over_diffuse(mixed, f0, beneath, albedo, {l.z, std::max(0.0, v.z), facet.cosine});
}

}  // namespace weft::simulator
