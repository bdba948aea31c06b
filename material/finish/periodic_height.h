// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"

namespace weft::material {

/// A height whose right border goes on at the left one, and the lower at the upper.
struct PeriodicHeight {
  Image<float> height;                 ///< pixels of height, mean 0; times mm_per_pixel it is millimetres
  Image<float> slope;                  ///< 2 planes, its gradient: to the right, up the picture; mean 0
  double mean_right = 0, mean_up = 0;  ///< mean slopes that were taken out: a periodic height has none
};

/// The periodic height whose gradient is closest to slopes (2 planes: to the right, up the picture), by least
/// squares over all waves of the picture (Frankot and Chellappa 1988, eq. 21). Derivatives are those of the
/// waves, exact for what the pixels can hold; waves of two pixels have none and are left out. No slope may be
/// NaN. Same bytes for any thread count.
PeriodicHeight periodic_height(const Image<float>& slope, int threads = 0);

}  // namespace weft::material
