// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"
#include "solver/height/slopes.h"

namespace weft::solver {

struct RelaxationOptions {
  int relaxations = 200;          ///< iterations a level: "until convergence" in the paper
  bool signs_as_printed = false;  ///< guess from the right and lower neighbour by adding the slope
};

/// Heights in pixels by relaxation from coarse to fine (seed 001, Algorithm 5): HeightMethod::kSeed.
///
/// Departures: R and D subtract the slope, without which nothing fits (printed: they add). A coarser level
/// has slopes twice as large, being between pixels twice as far apart, where the paper takes them as they
/// are. The mean slope is taken out first. Where a neighbour is missing, at the border or in the mask, the
/// mean is over those that are there.
void solve_as_seed(const Slopes& slopes, const SlopeSurvey& survey, const RelaxationOptions& options,
                   View<float> height, int threads);

}  // namespace weft::solver
