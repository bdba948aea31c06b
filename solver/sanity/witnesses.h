// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/vec.h"

// Whether photographs under known lights are what they are taken for: witnesses that need no truth. Each
// looks at means of small blocks of pixels, side by side in tiles, and solves them by least squares.

namespace weft::solver {

/// Readings of K photographs over one tile.
struct BlockTile {
  int width = 0, height = 0;    ///< blocks
  std::vector<Vec3> lights;     ///< of each photograph, direction times irradiance; y up, z to the camera
  std::vector<float> readings;  ///< of block (x, y) in photograph k at (y * width + x) * K + k; NaN: none
};

/// What is left of a reading that is predicted from the other lights, over the mean reading of its block:
/// the rms over the lights, the median over the blocks. Infinity where there are no more lights than
/// unknowns. With `has_constant` each block has an unknown light beside its three, the same in all
/// photographs.
double left_out_error(std::span<const BlockTile> tiles, bool has_constant = false);

/// The same with every reading seen through another curve first.
double left_out_error_through(std::span<const BlockTile> tiles, const std::function<double(double)>& curve);

/// The same with photograph k lit by light order[k].
double left_out_error_in_order(std::span<const BlockTile> tiles, std::span<const std::size_t> order);

/// How the lights' x and y may be meant. A half turn more makes no difference to a curl: it turns relief
/// inside out.
enum class Symmetry { kAsGiven, kMirrored, kQuarterTurned, kExchanged };
inline constexpr std::size_t kSymmetries = 4;

/// How far the solved normals are from those of a surface if the lights are meant so: the median over the
/// blocks of |dp/dy - dq/dx|, with slopes p and q. NaN where too few blocks have neighbours.
std::array<double, kSymmetries> curls(std::span<const BlockTile> tiles);

/// A light that is in all photographs, by its share of a block's mean reading: the median over the blocks.
double constant_share(std::span<const BlockTile> tiles);

}  // namespace weft::solver
