// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image.h"

// Horizons of a height map along parallel lines.

namespace weft::material {

/// Lines y = y0 + slope * x through a map of heights, x in columns and y down the rows, |slope| at most 1.
/// They are one row apart and go through the map's middle, so that a tile and its tiling have the same lines.
struct SweepLines {
  View<const float> height;  ///< in pixels; what is not finite is not there
  double slope = 0;
  bool is_tile = false;

  /// Line `line` at column x.
  double y_at(int line, int x) const {
    return (height.height() - 1) / 2.0 + line + (x - (height.width() - 1) / 2.0) * slope;
  }
  /// Lines first <= k < last have pixels between them and the next.
  int first() const;
  int last() const;
};

/// The horizon is open: nothing lies that way. Far below any slope, with a square that floats hold.
inline constexpr float kOpenHorizon = -1e15f;

/// For each column of a line, the horizon to one side: the slope of the line to it, in height a column, and
/// one over the columns it is away; kOpenHorizon and 0 where there is none.
struct Horizons {
  std::vector<float> slope, inverse;

  /// Seen from beside the line, `lower` by so much.
  float from(std::size_t column, float lower) const { return slope[column] + lower * inverse[column]; }
};
struct LineHorizons {
  Horizons to_left, to_right;
  std::vector<float> height;  ///< of the line, NaN where it has none
};

/// Walks lines; keeps scratch. One object a thread.
class LineSweep {
 public:
  explicit LineSweep(const SweepLines& lines);
  void walk(int line, LineHorizons& horizons);

 private:
  void sample(int line);

  const SweepLines& lines_;
  int first_column_, columns_;  ///< of what is walked: a tile and its period before and after it
  std::vector<float> z_, hull_z_;
  Horizons walked_;
  std::vector<int> hull_x_;
  std::vector<float> inverse_;  ///< [n] is 1 / n
};

}  // namespace weft::material
