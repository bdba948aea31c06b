// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/reflectance/directions.h"
#include "simulator/reflectance/fresnel.h"

namespace weft::simulator {

/// Blinn-Phong facets with the Schlick-Smith visibility (McAuley 2012, seed 004 "The Microfacet BRDF"). D has
/// (n.h)^m where the seed prints (n.v)^m, which would not depend on the light. Reciprocal. The 1/4 of
/// the facets' denominator stands with D, as the seed has it. Energy: lost, most at grazing angles.
struct BlinnPhong {
  double gloss = 0.5;  ///< 0 to 1; the power m is 2^(13 gloss)
  Rgb f0 = {0.04, 0.04, 0.04};
  Beneath beneath = Beneath::kLambert;

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;
  DirectionSample sample(Vec3 to_view, double u1, double u2) const;
  double density(Vec3 to_light, Vec3 to_view) const;

  double power() const;
  /// D(h) = (m + 2) (n.h)^m / (2 pi), 1/sr; integrates to 1 against n . h.
  double distribution(Vec3 facet_normal) const;

  bool operator==(const BlinnPhong&) const = default;
};

}  // namespace weft::simulator
