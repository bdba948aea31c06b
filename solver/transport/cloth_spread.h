// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/image/image.h"

namespace weft::solver {

/// Light that enters a yarn and leaves beside where it entered. Of what falls on a point, `share` leaves
/// elsewhere, as diffusion with absorption in a thin sheet has it: K0(r / l) / (2 pi l^2), of mean distance
/// pi l / 2 (Jensen et al., SIGGRAPH 2001, in a plane).
struct ClothSpread {
  double share = 0;  ///< 0 to kMostSpread
  double mean_mm = 0.3;

  friend bool operator==(const ClothSpread&, const ClothSpread&) = default;
};
inline constexpr double kMostSpread = 0.7;

/// What is seen of a wave of light over the cloth, over what enters: (1 - share) + share K at this frequency,
/// with K the transform of the kernel, 1 / (1 + (2 pi l f)^2). Frequency times mean distance has no unit.
double seen_of_wave(double share, double mean, double frequency);

/// Side of the cells, pixels, that carry spread light well enough: a fraction of its distance, and even for
/// the light of a mosaic.
int side_of_spread_cells(double mean_px, bool of_mosaic);

/// Where in its cell the light of a plane was seen, from the middle, in cells: one colour's photosites lie
/// beside it.
struct SeenAt {
  double x = 0, y = 0;
};

/// What had entered in other cells, by light that was seen in square ones: seen = (1 - share) E + share K *
/// E, and this is share K * E in the middles of the cells. Exact where cloth of one albedo goes on as a
/// mirror beyond the border; `mean_cells` is the mean distance in cells. Planes are spread by themselves,
/// `places` is of each. At most `threads` threads (0: all); the same bytes for any number of them.
Image<float> light_from_beside(const Image<float>& seen, std::span<const SeenAt> places, double share,
                               double mean_cells, int threads);

}  // namespace weft::solver
