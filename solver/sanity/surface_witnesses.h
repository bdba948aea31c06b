// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/sanity/block_tile.h"

// Whether the normals that photographs give are those of a surface: witnesses of the axes that lights mean.

namespace weft::solver {

/// How the lights' x and y may be meant. A half turn more makes no difference to a curl: it turns relief
/// inside out.
enum class Symmetry { kAsGiven, kMirrored, kQuarterTurned, kExchanged };
inline constexpr std::size_t kSymmetries = 4;

/// How far the solved normals are from those of a surface if the lights are meant so: over the blocks the
/// mean of |dp/dy - dq/dx|, with slopes p and q, without its largest fifth. NaN where too few blocks have
/// neighbours.
std::array<double, kSymmetries> curls(std::span<const BlockTile> tiles);

/// Which way round relief is. Of blocks that are darker under a light than their normal makes them, the share
/// that relief stands before, less that share of lit blocks: as it was solved, and inside out with lights on
/// the other side.
struct Sides {
  double as_given = 0, inside_out = 0;
  std::size_t dark = 0;  ///< blocks, once a light
};
Sides shadows_explained(std::span<const BlockTile> tiles);

/// The slope downwards towards the outside at the edge of a thing, over its size: the mean over the blocks
/// that have none beyond them. 1: it falls away everywhere; -1: it rises. NaN where too few are such.
double falls_at_edge(std::span<const BlockTile> tiles);

/// Heights of the blocks, in blocks, whose mean is 0: least squares of the slopes from block to block. 0
/// where nothing was solved.
std::vector<double> heights_of(const BlockTile& tile);

}  // namespace weft::solver
