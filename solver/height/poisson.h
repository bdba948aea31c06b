// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"
#include "solver/height/slopes.h"

namespace weft::solver {

/// The heights in pixels, mean 0, that fit the steps of a frame best where every pixel counts alike:
/// HeightMethod::kDct. `height` holds every intermediate, so nothing else of its size is needed.
void solve_whole_frame(const Slopes& slopes, const SlopeSurvey& survey, View<float> height, int threads);

}  // namespace weft::solver
