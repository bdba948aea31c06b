// SPDX-License-Identifier: Apache-2.0
#include "material/finish/lookup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace weft::material {
namespace {

// Weights of four nodes at `t` between the inner two, and their derivatives: cubic_weight() written out.
struct Weights {
  std::array<double, 4> value, slope;
};

Weights weights_at(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {
      {(-t3 + 2 * t2 - t) / 2, (3 * t3 - 5 * t2 + 2) / 2, (-3 * t3 + 4 * t2 + t) / 2, (t3 - t2) / 2},
      {(-3 * t2 + 4 * t - 1) / 2, (9 * t2 - 10 * t) / 2, (-9 * t2 + 8 * t + 1) / 2, (3 * t2 - 2 * t) / 2}};
}

}  // namespace

Lookup::Lookup(Size grid, int step)
    : grid_(grid), step_(step), places_({(grid.width - 1) / step + 4, (grid.height - 1) / step + 4}, 2) {}

void Lookup::set(int i, int j, Vec2 place) {
  places_(i, j, 0) = place.x;
  places_(i, j, 1) = place.y;
}

Lookup::Place Lookup::at(double column, double row) const {
  const int i = std::clamp(static_cast<int>(std::floor(column / step_)), 0, places_.width() - 4),
            j = std::clamp(static_cast<int>(std::floor(row / step_)), 0, places_.height() - 4);
  const Weights across = weights_at(column / step_ - i), down = weights_at(row / step_ - j);
  Place place;
  for (int l = 0; l < 4; ++l) {
    Vec2 at, by_column;
    for (int k = 0; k < 4; ++k) {
      const Vec2 value = node(i + k, j + l);
      at = at + across.value[static_cast<std::size_t>(k)] * value;
      by_column = by_column + across.slope[static_cast<std::size_t>(k)] * value;
    }
    const double weight = down.value[static_cast<std::size_t>(l)];
    place.at = place.at + weight * at;
    place.by_column = place.by_column + (weight / step_) * by_column;
    place.by_row = place.by_row + (down.slope[static_cast<std::size_t>(l)] / step_) * at;
  }
  return place;
}

}  // namespace weft::material
