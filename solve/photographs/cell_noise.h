// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/rig/radiometry.h"
#include "solver/frame_fit/cell_fit.h"

namespace weft::solve {

/// Sigma that noise alone gives the errors of cells, of the brightness; 0 where it is not known.
double cell_noise(const solver::FrameCells& cells, const solver::CellFit& fit,
                  const std::optional<NoiseModel>& noise);

}  // namespace weft::solve
