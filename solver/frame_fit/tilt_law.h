// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solver/frame_fit/cell_fit.h"

namespace weft::solver {

/// Light and highlights change across a frame: in each of its parts another function holds.
struct Parts {
  int across = 1, down = 1;
};

/// What is left of each cell of photograph k, of its brightness, where its light over its albedo is a
/// function of how it leans, whatever function; and where that leaves less than half as much, another
/// function more, of a highlight that goes by no albedo. Cloth that shines has them, however little they are
/// Lambert's law; a photograph of something else has not. Medians of cells that lean alike stand for the
/// first, lines by albedo through them for both (Tukey, Exploratory Data Analysis, 1977). NaN where too few
/// do.
std::vector<float> errors_by_tilt(const FrameCells& cells, const CellFit& fit, std::size_t k,
                                  Parts parts = {4, 2});

}  // namespace weft::solver
