// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solver/in_double/pixel.h"
#include "solver/method.h"

namespace weft::solver {

/// The estimators beyond least squares over one tile, in float32 vectors, with the shadow mask. Pixels side
/// by side go through the rounds that any of them asks for; what a pixel did not ask for leaves its bits
/// alone. Its truth is PixelSolver (solver/in_double/pixel.h), to which it also hands every pixel that
/// float32 cannot answer for, and with more than kMostTrimmedLights lights every pixel to be trimmed. A
/// reading that lies on a threshold may fall to either side.
void solve_weighted(const TileInput& input, const TileOutput& output, Estimator estimator,
                    double trim_from = kTrimFrom);

}  // namespace weft::solver
