// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/image/image.h"

namespace weft::material {

struct CavityOptions {
  double mm_per_pixel = 0;  ///< of the height map; must be given
  double radius_mm = 1;     ///< how far around a point its surroundings count; at least a pixel
  double range_mm = 0;  ///< above and below its surroundings, what is white and black; 0: three times the rms
  bool is_tile = false;
  int threads = 0;
};

struct Cavity {
  Image<float> cavity;  ///< 0 deep, 0.5 flat, 1 high
  double range_mm = 0;  ///< the one that was used
};

/// How far a point stands out of its surroundings, as masks for dirt and wear want it:
///     cavity = 0.5 + (h - g * h) / (2 range), held within 0 and 1,
/// where g is a round Gaussian of standard deviation radius / 2. Not a share of light: that is openness. A
/// height that is not finite has no part in any mean and is 0.5 itself.
///
/// kUsage for an empty map and for options out of range.
Result<Cavity> cavity(View<const float> height_mm, const CavityOptions& options);

}  // namespace weft::material
