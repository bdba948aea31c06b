// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/height/height.h"

namespace weft::solver {

/// A normal map that is read band by band, twice, each time from the top down.
struct NormalRows {
  Size size;
  /// Fills X, Y and Z, and the weights of height_from_normals, of as many rows as the views have, from row
  /// `y0` on. All views are `size.width` wide.
  std::function<Result<void>(int y0, const std::array<View<float>, 3>& normal, View<std::uint8_t> weight)>
      read;
};
/// Those of a map in memory; `mask` may be empty. Borrows both.
NormalRows rows_of(const std::array<View<const float>, 3>& normal, View<const std::uint8_t> mask);

/// The weight of a normal by its sigma: one over the variance, `usual_deg` (such as the median) being 32,
/// held within 1 and 255; 0 where sigma is not a number of 0 to below 180. Simulated scans gain nothing by
/// such weights, as wrong normals are wrong by more than their sigma: by default all pixels count alike.
inline std::uint8_t weight_of_sigma(float sigma_deg, double usual_deg) {
  if (!(sigma_deg >= 0 && sigma_deg < 180)) return 0;
  const double times_usual = usual_deg / std::max(static_cast<double>(sigma_deg), 1e-6);
  return static_cast<std::uint8_t>(std::lround(std::clamp(32 * times_usual * times_usual, 1.0, 255.0)));
}

struct TiledHeightOptions {
  /// The method is that of the tiles: by default the cosine transform where all pixels of one count alike.
  HeightOptions height = {};
  int tile_px = 512;  ///< side of a tile, from 64
  int halo_px = 128;  ///< what a tile shares with its neighbours on each side; from 8 to half a tile
};

struct TiledHeight {
  Image<float> height_mm;         ///< towards the camera; mean 0 over all pixels that count, 0 elsewhere
  std::int64_t pixels = 0;        ///< with a normal and a weight
  std::int64_t clamped = 0;       ///< of `pixels`, those tilted further than steepest_deg
  int tiles = 0;                  ///< that have such pixels
  int iterated_tiles = 0;         ///< those solved by multigrid
  double slope_residual_rms = 0;  ///< as in Height, over all tiles
};

/// The height map of height_from_normals, from a map that need not be in memory: in two steps, since a tile
/// by itself does not know the slow part.
///
/// Slopes are averaged over cells of 8 x 8 and solved as one small frame. A cubic B-spline through the cells
/// carries that to every pixel: it interpolates and smooths at once (by 4.6 pixels rms), and its slopes are
/// taken from those of the pixels. What is left is solved tile by tile with a halo, a free border and mean 0;
/// halos are blended by sin^2, weights of neighbours adding up to one.
///
/// On a weave with folds that is within 0.005 px rms and 0.02 px of the whole solve, whose own error is 0.03
/// px and more. Memory beside the output, bytes: 13 a pixel of (tile + 2 halo) rows, and two tiles a thread.
/// The same bytes for any number of threads. Parts of a mask without a common edge are not told apart: each
/// is level with its surroundings only as far as cells and tiles show it.
///
/// Errors: those of height_from_normals and of `rows`; kUsage for a tile or halo out of range.
Result<TiledHeight> tiled_height(const NormalRows& rows, const TiledHeightOptions& options);

}  // namespace weft::solver
