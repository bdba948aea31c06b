// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct EffectsOptions {
  double megapixels = 1;
  int threads = 0;  ///< 0: all the machine has
};

/// What each effect costs: frames of cloth_scene() under ten LEDs, from the scene to counts in memory. All
/// figures are wall time over pixels and frames, so what LEDs share (surface, mesh, bounces) is spread over
/// ten as in a session; the least of three rounds. Rows are the plain Lambert frame, each effect with only
/// what it requires, near light with noise, soft shadows, and all together:
///   ns_per_pixel  of a frame
///   added_ns      over the same scene without the effect
///   ratio         over the plain Lambert frame
///   s_16mp        seconds for a frame of 16 megapixels at that rate
/// Scenes that trace rays are measured on 1 megapixel at most, those that trace every frame anew because the
/// cloth moves on 0.1, and what takes over 3 seconds only once.
Result<Rows> effects_cost(const EffectsOptions& options);

}  // namespace weft::bench
