// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "solver/sanity/block_tile.h"

// Whether the values and lights of photographs are what they are taken for: witnesses that need no truth.
// Each block is solved by least squares from the readings that it has.

namespace weft::solver {

/// Tiles without the readings that Lambert's law does not explain, which become NaN: those in shadow, or so
/// aslant that they may be, and of what is left those that a lobe may add much to.
std::vector<BlockTile> without_shadows(std::vector<BlockTile> tiles, double least_lit = kLeastLit);
std::vector<BlockTile> without_highlights(std::vector<BlockTile> tiles);

/// How photographs may be meant. Nothing said: as they are taken for.
struct Meaning {
  bool has_constant = false;                 ///< each block has a light of its own in all photographs
  std::function<double(double)> curve = {};  ///< values are seen through it first
  std::span<const std::size_t> order = {};   ///< photograph k is lit by light order[k]
  double distance = 0;  ///< of all lamps from the middle of the picture, blocks; 0: as far as they are told
};

/// What is left of a reading that is predicted from the other lights, over the mean reading of its block:
/// the rms over the lights, the median over the blocks. Infinity where there are no more lights than
/// unknowns.
double left_out_error(std::span<const BlockTile> tiles, const Meaning& meaning = {});

/// A light that is in all photographs, by its share of a block's mean reading: the lower quartile and the
/// median over the blocks. NaN where lights do not tell it.
struct ConstantShare {
  double lower = 0, median = 0;
};
ConstantShare constant_share(std::span<const BlockTile> tiles);

/// The same tiles with readings divided by gains.
std::vector<BlockTile> evened_out(std::vector<BlockTile> tiles, std::span<const double> gains);

/// How many times the light told each photograph gathers, over their median: left-out light is predicted
/// and compared, over and over. The tiles have their shadows; `is_matt`: highlights count too. Empty where
/// too few blocks tell it.
std::vector<double> gains_of(std::span<const BlockTile> tiles, bool is_matt);

}  // namespace weft::solver
