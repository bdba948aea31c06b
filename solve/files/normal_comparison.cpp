// SPDX-License-Identifier: Apache-2.0
#include "solve/files/normal_comparison.h"

#include <algorithm>
#include <cmath>

namespace weft::solve {

NormalComparison summarize(std::vector<float>& angles_deg) {
  std::sort(angles_deg.begin(), angles_deg.end());
  NormalComparison c;
  c.pixels = static_cast<std::int64_t>(angles_deg.size());
  if (angles_deg.empty()) return c;
  double sum = 0;
  for (const float a : angles_deg) sum += a;
  const auto rank = [&](double share) {
    return angles_deg[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(angles_deg.size() - 1)))];
  };
  c.mean_deg = sum / static_cast<double>(angles_deg.size());
  c.median_deg = rank(0.5);
  c.p95_deg = rank(0.95);
  c.max_deg = angles_deg.back();
  return c;
}

}  // namespace weft::solve
