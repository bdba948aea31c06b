// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/multiple_scattering.h"

#include <algorithm>
#include <cmath>

#include "simulator/reflectance/directions.h"
#include "simulator/reflectance/fresnel.h"
#include "simulator/reflectance/lambert.h"

namespace weft::simulator {

Rgb MultipleScattering::evaluate(const Rgb& albedo, Vec3 l, Vec3 v) const {
  if (!(l.z > 0)) return {};
  const double g = gloss;
  const Facet facet = facet_between(l, v);
  const double l_h = facet.cosine;
  const double n_v = std::max(0.0, v.z);
  const double f_rough = l_h + fifth_power_of_rest(l_h);
  const double f_smooth = (1 - 0.75 * fifth_power_of_rest(l.z)) * (1 - 0.75 * fifth_power_of_rest(n_v));
  const double f_diffuse = std::lerp(f_rough, f_smooth, std::clamp(2.2 * g - 0.5, 0.0, 1.0));
  const double height = 34.5 * g * g - 59 * g + 24.5;
  const double width = std::max(73.2 * g - 21.2, 8.9);
  const double f_bump = height * l_h * std::exp2(-width * std::sqrt(facet.normal.z));
  return times_lambert(std::max(0.0, f_diffuse + f_bump), albedo);
}

}  // namespace weft::simulator
