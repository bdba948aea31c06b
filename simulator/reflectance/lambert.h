// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"

namespace weft::simulator {

/// A diffuse f that is `factor` times Lambert's.
inline Rgb times_lambert(double factor, const Rgb& albedo) {
  return {factor * albedo[0] / kPi, factor * albedo[1] / kPi, factor * albedo[2] / kPi};
}

/// The same to all sides (Lambert 1760; seed 002 eq. 1): f = albedo / pi. Reciprocal; reflects its albedo.
struct Lambert {
  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 /*to_view*/) const {
    return to_light.z > 0 ? times_lambert(1, albedo) : Rgb{};
  }

  bool operator==(const Lambert&) const = default;
};

}  // namespace weft::simulator
