// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/light_directions.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::solver {

ShadowReach shadow_reach(const Relief& relief, const LightDirections& lights, int most_px) {
  const int right = relief.height_mm.width() - 1, bottom = relief.height_mm.height() - 1;
  double farthest_px = 0;
  for (std::size_t k = 0; k < lights.count; ++k) {
    for (const auto& [x, y] : {std::pair{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}) {
      const Vec3 l = lights.at(k, x, y);
      const double reach_px = static_cast<double>(relief.top_px()) * std::hypot(l.x, l.y) / l.z;
      farthest_px = std::max(farthest_px, l.z > 0 ? reach_px : static_cast<double>(most_px) + 1);
    }
  }
  const int reach_px = static_cast<int>(std::ceil(std::min(farthest_px, 1e9)));
  return {std::clamp(reach_px, 1, std::max(most_px, 1)), reach_px > most_px};
}

}  // namespace weft::solver
