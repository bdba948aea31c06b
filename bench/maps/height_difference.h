// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image.h"

namespace weft::bench {

struct HeightDifference {
  double rms = 0, largest = 0;
};

/// Of two height maps in pixels, after the plane that fits it best.
HeightDifference height_difference(const Image<float>& a, const Image<float>& b, double mm_per_pixel);

/// Pixels from the 1st to the 99th percentile of a height map.
double relief(const Image<float>& height_mm, double mm_per_pixel);

}  // namespace weft::bench
