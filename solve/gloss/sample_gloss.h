// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/base/result.h"
#include "solve/correction/light_correction.h"
#include "solve/photographs/gloss_samples.h"
#include "solve/photographs/photographs.h"
#include "solver/method.h"

namespace weft::solve {

/// At most so many pixels of a pose are fitted: more say nothing of a lobe that model error does not drown.
inline constexpr std::size_t kGlossPixels = 4000;

/// At most kGlossPixels of the sample tiles (solver/sample_tiles.h), from where `base` solves them. Pixels
/// that follow each other are far apart in the frame, so that the first of them stand for all. Readings go
/// through the correction, if there is one. Errors: of the correction.
Result<GlossSamples> sample_gloss(const Photographs& photographs, const solver::Method& base,
                                  LightCorrection* correction, int threads);

/// The same pixels with the readings of these LEDs, in this order; of one that is not there none counts.
GlossSamples by_leds(const GlossSamples& samples, std::span<const int> leds);

}  // namespace weft::solve
