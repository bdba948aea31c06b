// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace weft::material {

struct GaussianGridOptions {
  double sigma_px = 1;   ///< above 0
  bool is_tile = false;  ///< goes on at the opposite border; else only what is inside counts
  int threads = 0;
};

/// A map blurred by a round Gaussian of any width at a cost that does not grow with it: means over cells of a
/// quarter sigma, the Gaussian over cells, and a cubic B-spline back to pixels. Variances of means and spline
/// are taken off the Gaussian's, so that all three together have the one asked for.
class GaussianGrid {
 public:
  /// Pixels that are not finite, or 0 in `counts` where that is not empty, have no part in any mean.
  GaussianGrid(View<const float> map, View<const std::uint8_t> counts, const GaussianGridOptions& options);

  /// Row y of the blurred map, as wide as the map; 0 where nothing is near.
  void read(int y, float* out) const;

 private:
  int column(int x) const;
  int row(int y) const;

  Size size_;
  bool is_tile_;
  int cell_ = 1;
  Image<float> grid_;
};

}  // namespace weft::material
