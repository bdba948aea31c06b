// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/height/islands.h"
#include "solver/height/slopes.h"

namespace weft::solver {

struct MultigridReport {
  int cycles = 0;
  double residual = 0;  ///< |source - A h| over |source|
};

/// The heights in pixels that fit the weighted steps of any mask best, up to a constant an island:
/// HeightMethod::kMultigrid. What is written where the weight is 0 means nothing.
MultigridReport solve_weighted(const Slopes& slopes, const SlopeSurvey& survey, const Islands& islands,
                               double tolerance, int most_cycles, View<float> height, int threads);

/// How a normal map becomes a height map. All but kSeed minimise the same sum over neighbouring pixels,
///   sum of w (h(b) - h(a) - (s(a) + s(b)) / 2)^2,
/// s being the slope towards b that the normal asks for; the border is free.
enum class HeightMethod {
  kAutomatic,  ///< kDct where every pixel counts alike, else kMultigrid
  /// Exact and direct, whole frames only: cosine transform along the rows (Simchony, Chellappa and Shao 1990,
  /// after Frankot and Chellappa 1988), then, instead of their second transform, one tridiagonal system a
  /// frequency down the columns (Hockney 1965): half the work, and done in place. A row whose length has a
  /// large prime factor is transformed by Bluestein's algorithm (1970), which is exact as well.
  kDct,
  /// Conjugate gradients with one V(2,2) cycle as preconditioner (Tatebe 1993): any mask, any weights.
  kMultigrid,
  /// Seed 001, Algorithm 5: relaxation from coarse to fine. The height of a neighbour is guessed from the
  /// slope of the left or upper pixel alone and iterations are few, so it is worse than the others; for
  /// comparison.
  kSeed,
};

struct HeightOptions {
  HeightMethod method = HeightMethod::kAutomatic;
  double mm_per_pixel = 1;
  double steepest_deg = 85;            ///< what is tilted further, or turned away, is taken as tilted so far
  int threads = 0;                     ///< 0: all the machine has. Changes no byte
  double tolerance = 1e-8;             ///< kMultigrid ends when its residual has fallen by this factor,
  int most_cycles = 100;               ///< or after so many cycles
  int seed_relaxations = 200;          ///< kSeed: iterations a level
  bool seed_signs_as_printed = false;  ///< kSeed: lines R and D of the paper add where they must subtract
};

struct Height {
  Image<float> height_mm;  ///< towards the camera; mean 0 over each island of connected pixels, 0 outside
  HeightMethod method = HeightMethod::kAutomatic;  ///< the one that ran
  std::int64_t pixels = 0;                         ///< with a normal and inside the mask
  std::int64_t clamped = 0;                        ///< of `pixels`, those tilted further than steepest_deg
  std::int64_t islands = 0;  ///< parts without a common edge: their heights are not related to each other
  int cycles = 0;            ///< kMultigrid: V-cycles done
  double residual = 0;       ///< kMultigrid: what they left of the right-hand side, relative
  /// Rms over neighbouring pixels of what the heights step by less what the slopes ask for, in pixels a pixel
  /// (1 is 45 degrees): how far the normals are from those of any surface.
  double slope_residual_rms = 0;
};

/// The height map whose slopes come closest to those of a normal map.
///
/// Normals are X right, Y up, Z to the camera, of any length; rows run downwards. A normal that is not
/// finite, is zero or points straight away from the camera has no slope: its pixel counts as masked out.
/// `mask` may be empty; 0 leaves a pixel out, other values are its weight relative to the other pixels (two
/// neighbours count with the harmonic mean of theirs, as if the weight were one over the variance of the
/// slope).
///
/// No height is NaN or infinite. Memory beside input and output, bytes a pixel: kDct 0.4 a thread at 16
/// megapixels and less above (a few rows, and one to four kilobytes a row of the image), kMultigrid 33 and up
/// to 5 more where the mask is all holes, kSeed 35.
///
/// Errors: kUsage for shapes that differ or options out of range, and for kDct where not all pixels count
/// alike; kBadData where no pixel has a normal.
Result<Height> height_from_normals(const std::array<View<const float>, 3>& normal,
                                   View<const std::uint8_t> mask, const HeightOptions& options);

}  // namespace weft::solver
