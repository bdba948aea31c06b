// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"

namespace weft::simulator {

/// Darker than Lambert at grazing angles where smooth, brighter where rough (Burley 2012, section 5.3).
/// Reciprocal. Energy: reflects more than it receives where rough and grazing, as seed 001 section 5.4 says.
struct DisneyDiffuse {
  double roughness = 0.5;  ///< 0 to 1

  Rgb evaluate(const Rgb& albedo, Vec3 to_light, Vec3 to_view) const;

  bool operator==(const DisneyDiffuse&) const = default;
};

}  // namespace weft::simulator
