// SPDX-License-Identifier: Apache-2.0
#include "core/rig/dark_counts.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace weft {

DarkCounts dark_counts(const RawFrame& dark) {
  constexpr std::int64_t kMostPixelsSeen = 1'000'000;
  const Size size = dark.counts.size();
  const int step = 2 * static_cast<int>(1 + size.pixels() / kMostPixelsSeen);
  std::array<std::vector<std::uint16_t>, 3> counts;
  for (int y = 0; y + 1 < size.height; y += step)
    for (int j = 0; j < 2; ++j)
      for (int x = 0; x < size.width; ++x)
        counts[static_cast<std::size_t>(dark.cfa.channel_at(x, j))].push_back(dark.counts(x, y + j));
  DarkCounts found;
  for (std::size_t c = 0; c < 3; ++c) {
    if (counts[c].empty()) continue;
    const auto at = [&](double share) {
      const auto n = static_cast<std::ptrdiff_t>(share * static_cast<double>(counts[c].size() - 1));
      std::nth_element(counts[c].begin(), counts[c].begin() + n, counts[c].end());
      return static_cast<double>(counts[c][static_cast<std::size_t>(n)]);
    };
    found.median[c] = at(0.5);
    found.spread = std::max(found.spread, at(0.95) - at(0.05));
  }
  return found;
}

}  // namespace weft
