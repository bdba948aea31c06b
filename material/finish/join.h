// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "material/finish/closed_cut.h"
#include "material/surface.h"

namespace weft::material {

enum class Axis { kX, kY };

/// Where a cloth goes on into itself: from `period` on along an axis come pixels that lie over the first
/// `overlap` ones.
struct Overlap {
  Axis axis = Axis::kX;
  int period = 0, overlap = 0;
};

/// Standard deviations of the slopes and of the albedo, by which differences count.
struct Scales {
  std::array<double, 2> slope = {1, 1};
  std::array<double, 3> albedo = {1, 1, 1};
};
Scales scales_of(const Surface& surface);

/// Squared differences of both sides of an overlap in slopes and albedo, in variances, one place across the
/// overlap a column and one along it a row: `size` along the axis, from `start`. Pixels without a solution
/// on either side cost 100. Where `folded` is above 0 rows from there on are added to the first ones: they
/// will lie over each other in the end.
Image<float> difference_in(const Surface& surface, const Overlap& overlap, int x0, int y0, int length,
                           int folded, const Scales& scales);

/// The cloth cut at `period`: before the cut stands what comes after the period, from the cut on what is
/// there, between them a smooth step of `feather` pixels. Every map takes the same cut and weights; status
/// and lobe have no means and take the heavier side.
Surface joined(const Surface& surface, const Overlap& overlap, const Cut& cut, int feather);

/// The weight of what is there at `place` across an overlap that is cut at `column`.
double own_weight(int place, int column, int feather);

}  // namespace weft::material
