// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace weft::solve {

/// Angles between two normal maps, over the pixels that count.
struct NormalComparison {
  std::int64_t pixels = 0;
  double mean_deg = 0, median_deg = 0, p95_deg = 0, max_deg = 0;
  double flipped_mean_deg = 0;  ///< mean with the y of one map turned round, as between OpenGL and DirectX
};

/// Mean, median, 95th percentile and maximum of angles, which are sorted on the way.
NormalComparison summarize(std::vector<float>& angles_deg);

}  // namespace weft::solve
