// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/reflectance/directions.h"

namespace weft::simulator {

/// Fibres that stand up: fuzz that lights up at the rim, over a balanced Lambert part (seed 000 eq. 21-23,
/// after Ashikhmin and Premoze 2007): an inverted Gaussian plus an offset, no shadowing. D is eq. 22; eq. 21
/// lacks its 1 / sin^4 and does not fit the norm. Reciprocal. The denominator of eq. 23 is 4e-4 at least, so
/// that f stays finite where light and view graze. Energy: kept to 0.5
/// percent, whatever f0 and albedo.
struct Cloth {
  double alpha = 0.5;           ///< spread of the fibres about upright, 0 (counts as kSmallestAlpha) to 1
  double amplitude = 4;         ///< of the fuzz against the offset; from 0
  Rgb f0 = {0.04, 0.04, 0.04};  ///< of another hue than the albedo: two-tone cloth

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;
  DirectionSample sample(Vec3 to_view, double u1, double u2) const;
  double density(Vec3 to_light, Vec3 to_view) const;

  /// D(h), 1/sr; integrates to 1 against n . h.
  double distribution(Vec3 facet_normal) const;

  bool operator==(const Cloth&) const = default;
};

}  // namespace weft::simulator
