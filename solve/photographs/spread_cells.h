// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve/photographs/photographs.h"
#include "solver/frame_fit/cell_fit.h"

namespace weft::solve {

/// Pixels of a filter cell, a side; cells lie below each other without a gap.
inline constexpr int kCellSide = 2;

/// Green readings of filter cells at up to 64 columns of the frame, in all rows.
solver::FrameCells spread_cells(const Photographs& photographs, int threads);

/// The first pixel of each of their columns.
std::vector<int> columns_of_cells(const Photographs& photographs);

}  // namespace weft::solve
