// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solve/photographs/photographs.h"
#include "solver/gates/told_spread.h"

namespace weft::solve {

/// Parts of a cloth by Lambert's law, whose cells are as large as its yarns allow: normals within a cell
/// hardly differ.
struct ClothWindows {
  int cell_px = 1;  ///< side of a cell
  std::vector<solver::LambertWindow> windows;
};

/// Up to four, over the frame. None where the frame is too small, where Lambert's law does not hold, and of
/// parts with holes.
ClothWindows cloth_windows(const Photographs& photographs, int threads);

}  // namespace weft::solve
