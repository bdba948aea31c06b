// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/reflectance/fresnel.h"

namespace weft::simulator {

/// Parallel fibres, each a cylinder that mirrors light into a cone about itself: the R lobe of Marschner et
/// al. 2003, M(theta_h) N(phi) / cos^2 theta_d with a Gaussian M and N = cos(phi / 2) / 4, over a diffuse
/// part. theta are angles to the plane across a fibre, phi the azimuth in it from light to view. What fibres
/// hide of each other is left to 1 / (2 (n.l + n.v - (n.l)(n.v))), as Cloth has it, which at normal incidence
/// is the half of a cylinder that faces the light. Reciprocal. It is no facet model: across the fibres it has
/// no width that could be fitted.
struct FibreCones {
  double spread_deg = 6;  ///< standard deviation of theta_h: how broad the cone is, 0.1 to 45
  double tilt_deg = 2;    ///< of the scales: the cone leans by twice as much, -20 to 20
  double twist_deg = 10;  ///< between fibres and x, -90 to 90
  Rgb f0 = {0.05, 0.05, 0.05};
  Beneath beneath = Beneath::kBalanced;

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;

  bool operator==(const FibreCones&) const = default;
};

}  // namespace weft::simulator
