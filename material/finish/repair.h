// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.h"
#include "material/lattice/lattice.h"
#include "material/surface.h"

namespace weft::material {

/// A place to be filled, in millimetres from the left and from the upper border: a circle, or a rectangle
/// where its sides are above 0.
struct Spot {
  double x_mm = 0, y_mm = 0;  ///< centre
  double radius_mm = 0;
  double width_mm = 0, height_mm = 0;
  /// Where the filling comes from, pixels x right, y up; nothing: the best is looked for. A recipe keeps it.
  std::optional<Vec2> source_px = {};
};

/// What repair is asked.
struct RepairOptions {
  std::vector<Spot> spots = {};
  Cell cell = {};      ///< repeats of the cloth, pixels: Lattice::axes, or a straightened cloth's
  int feather_px = 4;  ///< 0 to 16
  int ring_px = 9;     ///< around a spot: what must match, 1 to 64
  int threads = 0;
};

/// How a spot was filled.
struct Filled {
  Spot spot;  ///< with its source: the same again on another solve
  int repeats_a = 0, repeats_b = 0;
  double mismatch = 0;  ///< mean squared difference in the ring, in variances: 2 of unrelated places
  int pixels = 0;
};

struct Repaired {
  Surface surface;
  std::vector<Filled> filled;
};

/// Fills spots from whole repeats away, the same source for every map: of all repeats in reach the one whose
/// slopes and albedo differ least in a ring around the spot, moved by up to two pixels in halves. The median
/// difference of log albedo in the ring is added, since cloths are not lit and dyed evenly. Sources lie in
/// the cloth and touch no spot; of a tile they may cross its borders.
///
/// kUsage for options out of range, a spot outside of the cloth or of no pixel, a source that is not in the
/// cloth; kBadData where the cell has no area, or no repeat in reach is free of spots and solved.
Result<Repaired> repair(Surface surface, const RepairOptions& options);

}  // namespace weft::material
