// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

// What every reflectance model works with. Directions are unit vectors in the surface's own frame: z is the
// normal n, x the tangent, along the fibres where a model has any. l points to the light, v to the viewer,
// h is half-way between them: the normal of the facets that mirror one into the other.

namespace weft::simulator {

/// A lobe without roughness would be seen by no pixel: a roughness below this counts as this. Its highlight
/// is 0.15 degrees wide at half its height.
inline constexpr double kSmallestAlpha = 1e-3;

/// A direction towards a light that was drawn at random, and how densely it is drawn: 1/sr over the whole
/// sphere. Directions below the surface (z <= 0) occur; nothing is reflected there.
struct DirectionSample {
  Vec3 to_light;
  double density = 0;
};

/// A direction below the surface becomes the one on the horizon under the same azimuth; of straight down, x.
/// So a surface that is turned away from the viewer is shaded on without a step (Neubelt and Pettineo 2013,
/// fig. 1, instead of their eq. 10).
Vec3 above_horizon(Vec3 direction);

/// The facets that mirror light to view.
struct Facet {
  Vec3 normal;        ///< h, never below the horizon
  double cosine = 0;  ///< l . h = v . h, from 0 to 1
};
Facet facet_between(Vec3 to_light, Vec3 to_view);

/// The direction that a facet mirrors `to_view` into; either side of the facet reflects.
Vec3 mirrored(Vec3 to_view, Vec3 facet_normal);

/// The density of mirrored() directions, 1/sr, where facet normals are drawn with distribution(h) (n . h);
/// from dw_l = 4 |v . h| dw_h (Walter et al. 2007, eq. 14).
template <typename Distribution>
double mirrored_density(Vec3 to_light, Vec3 to_view, const Distribution& distribution) {
  constexpr double kPole = 1e-9;  // where light and view are opposite
  const Vec3 sum = to_light + to_view;
  const double twice_cosine = std::max(kPole, std::sqrt(dot(sum, sum)));
  const Vec3 h = (std::copysign(1.0, sum.z) / twice_cosine) * sum;
  return distribution(h) * h.z / (2 * twice_cosine);
}

/// A direction whose z is `cosine` and whose azimuth from x is 2 pi `turn`.
Vec3 from_cosine(double cosine, double turn);

/// Directions as Lambert reflects them: density max(0, n . l) / pi. u1 and u2 are uniform in [0, 1).
Vec3 cosine_direction(double u1, double u2);
double cosine_density(Vec3 direction);

/// Half of the directions as Lambert reflects them, half from `lobe`(u1, u2); the density is that of both.
template <typename Lobe>
Vec3 cosine_or_lobe(double u1, double u2, const Lobe& lobe) {
  return u1 < 0.5 ? cosine_direction(2 * u1, u2) : lobe(2 * u1 - 1, u2);
}
inline double cosine_or_lobe_density(Vec3 to_light, double lobe_density) {
  return 0.5 * (cosine_density(to_light) + lobe_density);
}

}  // namespace weft::simulator
