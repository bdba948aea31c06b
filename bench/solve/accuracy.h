// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct AccuracyOptions {
  double megapixels = 0.25;
  int threads = 0;  ///< 0: all the machine has
};

/// Errors without noise against the simulator's truth: seed on doubles (a plane tilted by 15 degrees),
/// fast on floats as mosaic and as RGB (a twill; in memory, no quantisation), and fast through 14-bit DNG
/// files and EXR maps (a flat cloth of albedo 0.2).
Result<Rows> solve_exactness(const AccuracyOptions& options);

/// Scatter of one photosite under photon and read noise, at a frontal normal: rms angle against the
/// Cramer-Rao bound and against the sigma that the method predicted, for three albedos at white exposure.
Result<Rows> solve_noise(const AccuracyOptions& options);

/// Solving the mosaic and demosaicing the albedo, against demosaicing every photograph and solving RGB: error
/// and time of both on noisy cloth.
Result<Rows> solve_order(const AccuracyOptions& options);

}  // namespace weft::bench
