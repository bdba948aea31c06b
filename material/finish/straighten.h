// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "material/finish/lock_in.h"
#include "material/finish/lookup.h"
#include "material/lattice/lattice.h"
#include "material/surface.h"

namespace weft::material {

/// What is asked of straightening.
struct StraightenOptions {
  double mm_per_pixel = 0;  ///< 0: the surface's
  /// Repeats along x and y whose length becomes a whole number of pixels, so that a tile of as many can be
  /// cut; 0: all that lie in the frame but one, which joins the ends.
  int repeats_x = 0, repeats_y = 0;
  double lock_in_repeats = 0.8;  ///< sigma of the phases' low pass, in repeats of the weave; 0: affine alone
  int threads = 0;
};

/// Beyond these what was found may be the diagonals of a weave, so that somebody is asked first.
inline constexpr double kMostTurn_deg = 15, kMostSkew_deg = 3;
bool is_to_be_asked(const Lattice& lattice);

/// A cloth whose yarns run along the axes, and what was done to it.
struct Straightened {
  Surface surface;
  int repeats_x = 0, repeats_y = 0;
  Size period_px;                                 ///< of so many repeats
  double mm_per_pixel_x = 0, mm_per_pixel_y = 0;  ///< exactly; surface.mm_per_pixel is their geometric mean
  double turn_deg = 0;                            ///< of the yarns along x, taken out; counterclockwise
  double skew_deg = 0;                            ///< of the yarns along y beyond that, taken out
  Displacement displacement;  ///< of the photographed cloth; its range beyond turn and skew:
  double largest_pull_mm = 0, rms_pull_mm = 0;
  Lookup lookup;  ///< of the surface's pixels in the photographed one
};

/// Turns, shears and unbends a cloth so that its repeats lie in rows and columns: the lattice by an affine
/// map, bow and pulls by the lock-in displacement, both and any change of scale in one lookup with one cubic
/// convolution (Keys 1981). Slopes change as covectors do, p' = p dx/du + q dy/du; albedo and opacity as
/// values; sigma as the root of the mean square; status and lobe are the nearest pixel's, the lobe's azimuth
/// turned. A pixel whose neighbours hold no solution in half their weight has none.
///
/// kBadData as in find_lattice(), and where the lattice has no repeat; kUsage for a scale that is not above 0
/// or makes no picture, and for a number of repeats below 0.
Result<Straightened> straighten(const Surface& surface, const Lattice& lattice,
                                const StraightenOptions& options = {});

}  // namespace weft::material
