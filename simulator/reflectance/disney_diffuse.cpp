// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/disney_diffuse.h"

#include <algorithm>

#include "simulator/reflectance/directions.h"
#include "simulator/reflectance/fresnel.h"
#include "simulator/reflectance/lambert.h"

namespace weft::simulator {

Rgb DisneyDiffuse::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const double l_h = facet_between(l, v).cosine;
  const double rise = 2 * roughness * l_h * l_h - 0.5;  // Burley's F_D90 - 1
  const double grazing_l = fifth_power_of_rest(l.z);
  const double grazing_v = fifth_power_of_rest(std::max(0.0, v.z));
  return times_lambert((1 + rise * grazing_l) * (1 + rise * grazing_v), albedo);
}

}  // namespace weft::simulator
