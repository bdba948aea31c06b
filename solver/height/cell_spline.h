// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/image/image.h"

namespace weft::solver {

/// A smooth surface over a frame from one height a cell of 8 x 8 pixels: the uniform cubic B-spline with the
/// cells' heights as coefficients, continued straight beyond the border.
class CellSpline {
 public:
  static constexpr int kCell = 8;
  /// The whole cells of a frame, at least one. What is left at its right and lower border is beyond them.
  static Size cells_of(Size size);

  CellSpline() = default;
  explicit CellSpline(View<const float> cells);

  /// One row of the frame: heights, and their derivatives to the right and down the rows, a pixel.
  struct Row {
    std::vector<float> height, right, down;
  };
  void read(int y, int width, Row& row) const;

 private:
  void extend(View<const float> cells);
  void sharpen();

  Image<float> coefficients_;  ///< three more on each side than cells
};

}  // namespace weft::solver
