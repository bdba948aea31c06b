// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "simulator/reflectance/ggx.h"

namespace weft::simulator {

/// GGX of parallel fibres (seed 000 eq. 11-14): satin. Fibres are round, so facets spread across them: here x
/// runs along the fibres, and the seed's tangent, along which its roughness is alpha, is y. Smith's
/// visibility is the one that matches this D (Heitz 2014), where the seed leaves its own unsaid. Reciprocal.
/// Energy as Ggx.
struct AnisotropicGgx {
  double alpha = 0.5;       ///< roughness across the fibres (seed 000 eq. 12), 0 to 1
  double anisotropy = 0.5;  ///< 0 to 1: the roughness along the fibres is alpha (1 - anisotropy) (eq. 13)
  Rgb f0 = {0.04, 0.04, 0.04};
  Beneath beneath = Beneath::kBalanced;

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;
  DirectionSample sample(Vec3 to_view, double u1, double u2) const;
  double density(Vec3 to_light, Vec3 to_view) const;
  GgxLobe lobe() const { return {alpha * (1 - anisotropy), alpha}; }

  bool operator==(const AnisotropicGgx&) const = default;
};

}  // namespace weft::simulator
