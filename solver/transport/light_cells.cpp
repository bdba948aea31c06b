// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/light_cells.h"

#include <algorithm>

namespace weft::solver {
namespace {

float between(float from, float to, float share) {
  return from + share * (to - from);
}

LightCells::Direction between(LightCells::Direction from, LightCells::Direction to, float share) {
  return {between(from.x, to.x, share), between(from.y, to.y, share), between(from.z, to.z, share)};
}

/// Where along its cell a pixel lies; the last cell ends with the picture.
float share_of_cell(int at, int begin, int length) {
  const int end = std::min(begin + LightCells::kCell, length - 1);
  return end > begin ? static_cast<float>(at - begin) / static_cast<float>(end - begin) : 0.0f;
}

}  // namespace

LightCells::LightCells(const LightDirections& lights, Rect tile, Size picture)
    : picture_(picture),
      first_column_(tile.x0 / kCell),
      first_row_(tile.y0 / kCell),
      columns_((tile.x1 - 1) / kCell - first_column_ + 2),
      rows_((tile.y1 - 1) / kCell - first_row_ + 2) {
  corners_.reserve(lights.count * static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t k = 0; k < lights.count; ++k) {
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const Vec3 l = lights.at(k, std::min((first_column_ + i) * kCell, picture.width - 1),
                                 std::min((first_row_ + j) * kCell, picture.height - 1));
        corners_.push_back({static_cast<float>(l.x), static_cast<float>(l.y), static_cast<float>(l.z)});
      }
    }
  }
}

void LightCells::read(std::size_t k, int x, int y, std::array<Direction, kCell>& directions) const {
  const int i = x / kCell - first_column_, j = y / kCell - first_row_;
  const Direction* above = &corners_[(k * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(j)) *
                                         static_cast<std::size_t>(columns_) +
                                     static_cast<std::size_t>(i)];
  const Direction* below = above + columns_;
  const float down = share_of_cell(y, y / kCell * kCell, picture_.height);
  const Direction left = between(above[0], below[0], down), right = between(above[1], below[1], down);
  for (int lane = 0; lane < kCell; ++lane)
    directions[static_cast<std::size_t>(lane)] =
        between(left, right, share_of_cell(x + lane, x, picture_.width));
}

}  // namespace weft::solver
