// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solve/photographs/photographs.h"
#include "solver/sanity/block_tile.h"

namespace weft::solve {

/// Photographs on the sample tiles (solver/sample_tiles.h), as means of squares of `side` pixels, whole cells
/// of a colour filter. A mosaic's block has all its colours; developed photographs are seen by their green.
std::vector<solver::BlockTile> block_tiles(const Photographs& photographs, int side, int threads);

}  // namespace weft::solve
