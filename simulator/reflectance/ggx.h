// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/reflectance/directions.h"
#include "simulator/reflectance/fresnel.h"

namespace weft::simulator {

/// GGX (Walter et al. 2007): long-tailed highlights. One lobe over a diffuse part (seed 000 eq. 1-9 and 15).
/// Reciprocal. Energy: light that facets shadow is lost, so rough lobes are darker than they should
/// be; a balanced smooth one over white gives too much at grazing angles.
struct Ggx {
  double alpha = 0.5;  ///< roughness, 0 to 1; seed 002 writes alpha = roughness^2
  Rgb f0 = {0.04, 0.04, 0.04};
  Beneath beneath = Beneath::kBalanced;

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;
  DirectionSample sample(Vec3 to_view, double u1, double u2) const;
  double density(Vec3 to_light, Vec3 to_view) const;

  bool operator==(const Ggx&) const = default;
};

/// The lobe itself, with a roughness along x and one along y.
class GgxLobe {
 public:
  GgxLobe(double alpha_x, double alpha_y);

  /// D(h) of seed 000 eq. 14, and of eq. 2 where both are alpha; 1/sr. Integrates to 1 against n . h.
  double distribution(Vec3 facet_normal) const;
  /// V_1 of seed 000 eq. 9, whose square is the 1/4 of eq. 1 and all shadowing; with two roughnesses its root
  /// is sqrt(z^2 + (alpha_x x)^2 + (alpha_y y)^2), which is Smith's for eq. 14 (Heitz 2014).
  double visibility(Vec3 direction) const;
  /// D V of seed 000 eq. 7, without Fresnel.
  double evaluate(Vec3 to_light, Vec3 to_view, const Facet& facet) const;

  /// Mirrored off the facets that the viewer sees (Dupuy and Benyoub, "Sampling visible GGX normals with
  /// spherical caps", 2023), with the density D V_1(v) / 2.
  Vec3 sample(Vec3 to_view, double u1, double u2) const;
  double density(Vec3 to_light, Vec3 to_view) const;

 private:
  double alpha_x_, alpha_y_;
};

}  // namespace weft::simulator
