// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct HeightSpeedOptions {
  double megapixels = 4;
  int threads = 0;  ///< 0: all the machine has
};

/// From normals to heights of a weave with folds, a row a method: its rms error in pixels after the best
/// plane, its time, and the memory it took at its peak beside the normals. `ratio_to_copy` is against a copy
/// of the bytes that have to move at least: three floats in, one out. `multigrid-masked` leaves one pixel in
/// seven out, and `dct-prime` has rows of a prime length.
Result<Rows> height_speed(const HeightSpeedOptions& options);

}  // namespace weft::bench
