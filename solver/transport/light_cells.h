// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/image/image.h"
#include "solver/transport/light_directions.h"

namespace weft::solver {

/// The directions to all lights at the corners of the cells of a tile, and between.
class LightCells {
 public:
  static constexpr int kCell = LightDirections::kCell;
  struct Direction {
    float x = 0, y = 0, z = 0;
  };

  LightCells(const LightDirections& lights, Rect tile, Size picture);

  /// To light k at the pixels of row y from x, a multiple of kCell, on.
  void read(std::size_t k, int x, int y, std::array<Direction, kCell>& directions) const;

 private:
  Size picture_;
  int first_column_, first_row_;
  int columns_, rows_;
  std::vector<Direction> corners_;  // light by light, row by row
};

}  // namespace weft::solver
