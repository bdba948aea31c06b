// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/light_strengths.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace weft::solve {

LightStrengths::LightStrengths(const LightField& field, Size size, int threads)
    : columns_((size.width - 1) / kCell + 2), rows_((size.height - 1) / kCell + 2) {
  const auto columns = static_cast<std::size_t>(columns_), rows = static_cast<std::size_t>(rows_);
  corner_.resize(3 * field.count() * rows * columns);
  parallel_for(3 * field.count() * rows, threads, [&](std::size_t line, int) {
    const std::size_t plane = line / rows;
    const int y = static_cast<int>(line % rows) * kCell;
    for (std::size_t i = 0; i < columns; ++i) {
      const int x = static_cast<int>(i) * kCell;
      corner_[line * columns + i] =
          static_cast<float>(field.at(plane / 3, static_cast<int>(plane % 3), x, y).strength);
    }
  });
}

void LightStrengths::read(std::size_t k, int c, int y, int x0, int x1, float* strength) const {
  const std::size_t line = (k * 3 + static_cast<std::size_t>(c)) * static_cast<std::size_t>(rows_) +
                           static_cast<std::size_t>(y / kCell);
  const float* above = corner_.data() + line * static_cast<std::size_t>(columns_);
  const float* below = above + columns_;
  const float down = static_cast<float>(y % kCell) / kCell;
  for (int cell = x0 / kCell; cell * kCell < x1; ++cell) {
    const float left = above[cell] + down * (below[cell] - above[cell]);
    const float right = above[cell + 1] + down * (below[cell + 1] - above[cell + 1]);
    for (int x = std::max(cell * kCell, x0); x < std::min((cell + 1) * kCell, x1); ++x)
      strength[x - x0] = left + (right - left) * static_cast<float>(x - cell * kCell) / kCell;
  }
}

}  // namespace weft::solve
