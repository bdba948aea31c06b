// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/vec.h"

namespace weft::solver {

/// Readings of K photographs over one tile: means of small square blocks of pixels, side by side.
struct BlockTile {
  int width = 0, height = 0;  ///< blocks
  std::size_t count = 0;      ///< K
  /// That of photograph k is at (row * columns + column) * K + k, direction times irradiance; y up, z to the
  /// camera. Rows and columns of the grid are so many blocks apart, from block (0, 0) on, with one more than
  /// the tile needs; 0: lights are alike everywhere, and there is one place.
  std::vector<Vec3> lights;
  int light_step = 0, light_columns = 1;
  std::vector<float> readings;  ///< of block (x, y) in photograph k at (y * width + x) * K + k; NaN: none
  std::vector<double> heights;  ///< of the blocks, in blocks (surface_witnesses.h); empty: flat
  double left = 0, top = 0;     ///< of block (0, 0), in blocks from the middle of the picture, y up

  std::size_t blocks() const { return count == 0 ? 0 : readings.size() / count; }
  std::span<const float> of(std::size_t block) const {
    return std::span(readings).subspan(block * count, count);
  }
  std::span<float> of(std::size_t block) { return std::span(readings).subspan(block * count, count); }
  Vec3 light(std::size_t block, std::size_t k) const {
    if (light_step == 0) return lights[k];
    const auto x = block % static_cast<std::size_t>(width), y = block / static_cast<std::size_t>(width);
    const auto step = static_cast<std::size_t>(light_step), columns = static_cast<std::size_t>(light_columns);
    const double u = static_cast<double>(x % step) / light_step,
                 v = static_cast<double>(y % step) / light_step;
    const std::size_t at = (y / step * columns + x / step) * count + k, below = at + columns * count;
    return (1 - v) * ((1 - u) * lights[at] + u * lights[at + count]) +
           v * ((1 - u) * lights[below] + u * lights[below + count]);
  }
};

/// As a share of a block's mean reading: a light that gives less is in shadow, or so aslant that it may be.
inline constexpr double kLeastLit = 0.25;

}  // namespace weft::solver
