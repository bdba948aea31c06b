// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"

namespace weft::simulator {

/// Diffuse light bounced between facets beneath a surface of f0 = 0.04, flat where rough and round where
/// smooth: the fit of Chan 2018 (seed 001 eq. 64-69). Reciprocal. The bump of eq. 68 is negative for gloss
/// between 49/69 and 1 and would take f below 0 where light and view graze: f is 0 there. No specular lobe.
/// Energy: rough and white it gives up to 1.16 of what it receives at grazing angles.
struct MultipleScattering {
  double gloss = 0;  ///< 0 (rough) to 1 (smooth)

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;

  bool operator==(const MultipleScattering&) const = default;
};

}  // namespace weft::simulator
