// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"

namespace weft::simulator {

/// Lambertian facets that shadow each other and shine back to the light (Oren and Nayar 1994, their
/// qualitative model: single scattering). Reciprocal. Energy: loses what a second bounce would return. f
/// itself grows without bound where light and view graze side by side; the denominator there is 1e-4 at
/// least.
struct OrenNayar {
  double sigma = 0.5;  ///< standard deviation of the facets' slope angle, radians, 0 (Lambert) to pi / 2

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;

  bool operator==(const OrenNayar&) const = default;
};

}  // namespace weft::simulator
