// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/reflectance/ggx.h"

namespace weft::simulator {

/// Two lobes of GGX in every point, as a cloth has whose finish lies on rough fibres. Reciprocal. Energy as
/// Ggx.
struct MixedGgx {
  double alpha = 0.15;
  double second_alpha = 0.5;
  double second_share = 0.5;  ///< of the facets, 0 to 1
  Rgb f0 = {0.04, 0.04, 0.04};
  Beneath beneath = Beneath::kBalanced;

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;

  bool operator==(const MixedGgx&) const = default;
};

}  // namespace weft::simulator
