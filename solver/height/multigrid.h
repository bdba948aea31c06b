// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"
#include "solver/height/islands.h"
#include "solver/height/slopes.h"

namespace weft::solver {

struct MultigridReport {
  int cycles = 0;
  double residual = 0;  ///< |source - A h| over |source|
};

/// The heights in pixels that fit the weighted steps of any mask best, up to a constant an island:
/// HeightMethod::kMultigrid. What is written where the weight is 0 means nothing.
MultigridReport solve_weighted(const Slopes& slopes, const SlopeSurvey& survey, const Islands& islands,
                               double tolerance, int most_cycles, View<float> height, int threads);

}  // namespace weft::solver
