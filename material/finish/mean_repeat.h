// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image.h"
#include "material/surface.h"

namespace weft::material {

/// A plane less the mean over all its repeats of `repeat_x` x `repeat_y` pixels, place by place. Places in
/// the repeat are a pixel wide at most.
Image<float> without_mean_repeat(View<const float> plane, double repeat_x, double repeat_y);

/// The share of the slopes' variance that comes again in every repeat, 0 to 1: of an analysis of variance by
/// place in the repeat, so that few repeats do not look alike by chance. Pixels without a solution are left
/// out.
double repeating_share(const Surface& surface, double repeat_x, double repeat_y);

}  // namespace weft::material
