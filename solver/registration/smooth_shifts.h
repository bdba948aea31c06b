// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "solver/registration/registration.h"

namespace weft::solver {

/// The points of a tile at which shots are compared: every second pixel both ways, far enough inside for any
/// shift that is looked for.
struct PointGrid {
  explicit PointGrid(Size tile);
  int columns = 0, rows = 0;
  int count() const { return columns * rows; }
  /// Pixel of the tile.
  static int pixel(int index);
};

/// One shot of a tile, smoothed, as seen through a shift.
struct SmoothShot {
  std::vector<float> value, dx, dy;  ///< by point, row by row: reading, and its slope a pixel
  double noise = 0;                  ///< variance of `value` for variance 1 of a reading
  double slope_noise = 0;            ///< of `dx`, and of `dy`
};

/// The green sites of a mosaic - all sites where `mosaic` is false - weighted by a Gaussian of standard
/// deviation 1 px times (3 - r^2) / 2 along each axis: flat to fourth order where a weave has its energy, and
/// at the repeats of the greens' lattice below 0.002. A lattice of one colour alone, 2 px apart, would fold a
/// fine weave onto itself. What touches a reading that is not finite is not finite.
SmoothShot smooth(View<const float> readings, bool mosaic, const CfaPattern& cfa,
                  ClothShift::Displacement shift, const PointGrid& grid);

}  // namespace weft::solver
