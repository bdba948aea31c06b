// SPDX-License-Identifier: Apache-2.0
#include "material/assets/shade.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "solver/reflectance/lobe.h"

namespace weft::app {
namespace {

using solver::Lobe;
using solver::LobeFamily;

constexpr double kLeastAlpha = 0.02;  // below it a lobe is seen by no pixel

// pi D V of a lobe, without its reflectance.
double facets(Lobe lobe, Vec3 normal, const solver::LitFrom& from, double yarn) {
  lobe.f0 = 1;
  return solver::specular(lobe, normal, from, yarn);
}

double schlick(double f0, double cosine) {
  return f0 + (1 - f0) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

}  // namespace

Rgb shaded(const ShadedPoint& point, Vec3 normal, Vec3 to_light, Vec3 to_view) {
  const double n_l = dot(normal, to_light);
  if (!(n_l > 0)) return {0, 0, 0};
  const solver::LitFrom from(to_light, to_view);
  const double alpha = std::clamp(point.alpha, kLeastAlpha, 1.0);
  const Lobe ggx = {.family = LobeFamily::kAnisotropicGgx,
                    .alpha = alpha,
                    .along = std::clamp(point.alpha_along / alpha, 0.05, 20.0)};
  const Lobe fuzz = {.family = LobeFamily::kCloth, .alpha = std::clamp(point.sheen_alpha, kLeastAlpha, 1.0)};
  const double mirrored = point.cloth < 1 ? facets(ggx, normal, from, radians(point.yarn_deg)) : 0;
  const double fuzzed = point.cloth > 0 ? facets(fuzz, normal, from, 0) : 0;
  Rgb out = {};
  for (std::size_t c = 0; c < out.size(); ++c) {
    const double f0 =
        point.f0 * point.f0_tint[c] + point.metallic * (point.albedo[c] - point.f0 * point.f0_tint[c]);
    const double f = schlick(f0, from.light_half), f_sheen = schlick(point.sheen[c], from.light_half);
    const double diffuse = std::max(point.albedo[c], 0.0) * (1 - point.metallic);
    const double by_ggx = diffuse * (1 - f) + f * mirrored;
    const double by_cloth = diffuse * (1 - f_sheen) + f_sheen * fuzzed;
    out[c] = n_l * (by_ggx + point.cloth * (by_cloth - by_ggx));
  }
  return out;
}

}  // namespace weft::app
