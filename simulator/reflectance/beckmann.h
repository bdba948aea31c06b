// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/reflectance/directions.h"
#include "simulator/reflectance/fresnel.h"

namespace weft::simulator {

/// Gaussian slopes: highlights with short tails (Beckmann; seed 000 appendix A, after Walter et al. 2007,
/// with their rational fit of Smith's shadowing). Reciprocal. Energy as Ggx.
struct Beckmann {
  double alpha = 0.5;  ///< roughness, 0 (counts as kSmallestAlpha) to 1
  Rgb f0 = {0.04, 0.04, 0.04};
  Beneath beneath = Beneath::kBalanced;

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;
  DirectionSample sample(Vec3 to_view, double u1, double u2) const;
  double density(Vec3 to_light, Vec3 to_view) const;

  /// D(h), 1/sr; integrates to 1 against n . h.
  double distribution(Vec3 facet_normal) const;
  /// G_1 / (n . direction), finite at the horizon; at most 1 / (n . direction), where the fit
  /// reaches 1.00006.
  double shadowing_over_cosine(double cosine) const;

  bool operator==(const Beckmann&) const = default;
};

}  // namespace weft::simulator
