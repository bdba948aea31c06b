// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "material/finish/join.h"
#include "material/finish/straighten.h"
#include "material/surface.h"

namespace weft::material {

/// What is asked of a tile.
struct TilingOptions {
  Size period_px = {};  ///< of the tile; 0: as wide, as high as fits
  /// The repeat along x and y, pixels; 0: a cloth without repeat, cut where it is closest to itself.
  double repeat_x_px = 0, repeat_y_px = 0;
  int overlap_px =
      0;  ///< where the cut may run; 0: whole repeats, 24 pixels at least, or an eighth of a felt
  int feather_px = 3;  ///< of the step at the cut, 1 to 16
  int threads = 0;
};

/// The period and the repeat that straighten() left.
TilingOptions tile_of(const Straightened& straightened);

/// One joint of a tile, along one axis. But for the steps at the border all are of what lies within ten
/// pixels of the cut, over the same of both sides before they were joined: 1 means that nothing is to be
/// seen, less than 1 that the joint is blurred.
struct Seam {
  int overlap_px = 0;
  double cut_cost = 0;         ///< mean squared difference of both sides along the cut, in variances
  double wrap_step_slope = 0;  ///< rms step at the border over the largest one at the same place of a repeat
  double wrap_step_albedo = 0;
  double wrap_step_height = 0;
  double gradient_slope = 0;  ///< energy of the steps from pixel to pixel along the axis
  double gradient_albedo = 0;
  double residual = 0;  ///< sd of the slopes from the mean repeat; 0 without a repeat
  double curl = 0;      ///< rms
};

/// A cloth that goes on at its borders.
struct Tile {
  Surface surface;         ///< is_tile; slopes have mean 0
  Image<float> height_mm;  ///< periodic, mean 0
  int x0 = 0, y0 = 0;      ///< of its first pixel in the straightened cloth
  bool has_repeat = false;
  int places = 0;  ///< starts that were compared
  Seam x, y;
  double mean_right = 0, mean_up = 0;  ///< slopes that were taken out, so that the tile does not climb
  double relief_mm = 0;                ///< largest less smallest height
  /// Angle of the normals to those of the height, 99 of 100 pixels are below: at the cuts and everywhere.
  double normal_p99_at_cuts_deg = 0, normal_p99_deg = 0;
};

/// Cuts whole repeats out of a straightened cloth so that its borders meet: at the start, of all that are
/// whole repeats apart, where both sides differ least; along a closed cut of least error through slopes and
/// albedo (Efros and Freeman 2001) in x, then in y. Within two feathers of a cut the slopes are those of the
/// periodic height, so that the joint has no curl.
///
/// kUsage for a tile of a tile, a feather out of range and a period that is no whole number of repeats;
/// kBadData as in find_lattice(), where a repeat is wider than half the cloth, and where period and overlap
/// do not fit in. Same bytes for any thread count.
Result<Tile> tile(const Surface& surface, const TilingOptions& options);

}  // namespace weft::material
