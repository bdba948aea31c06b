// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"

namespace weft::material {

/// A Gaussian mean of `sigma_px` in place, by three extended boxes (Gwosdek et al. 2011): its cost does not
/// grow with sigma, its standard deviation is exact, its values are within 3 percent of the peak's. What lies
/// beyond the border has no weight. `sigma_px` 0 leaves the plane as it is.
void smooth(View<float> plane, double sigma_px, int threads);

}  // namespace weft::material
