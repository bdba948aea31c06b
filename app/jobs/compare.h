// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/result.h"

namespace weft::app {

/// Angles between two normal maps, over the pixels that count.
struct NormalComparison {
  std::int64_t pixels = 0;
  double mean_deg = 0, median_deg = 0, p95_deg = 0, max_deg = 0;
};

/// Relative differences of two albedo maps over R, G, B of the pixels that count.
struct AlbedoComparison {
  std::int64_t pixels = 0;
  double mean_rel = 0;  ///< mean of |A - B| / B
  double bias_rel = 0;  ///< mean of (A - B) / B
};

/// Mean, median, 95th percentile and maximum of angles, which are sorted on the way.
NormalComparison summarize(std::vector<float>& angles_deg);

/// Compares `tested` with `truth`, of equal size. A pixel counts if it is inside the mask (over one half;
/// empty: all), finite in both maps and of some length in the truth. Normal maps hold X, Y, Z; integer files
/// hold (n + 1) / 2.
Result<NormalComparison> compare_normals(const std::filesystem::path& tested,
                                         const std::filesystem::path& truth,
                                         const std::filesystem::path& mask);
Result<AlbedoComparison> compare_albedo(const std::filesystem::path& tested,
                                        const std::filesystem::path& truth,
                                        const std::filesystem::path& mask);

}  // namespace weft::app
