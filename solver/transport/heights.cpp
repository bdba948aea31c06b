// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/heights.h"

#include <algorithm>

namespace weft::solver {

Image<float> heights_around(const Relief& relief, Rect area) {
  constexpr float kNowhere_px = -1e6F;
  Image<float> height({area.width(), area.height()});
  const Rect picture = relief.pixels();
  for (int y = area.y0; y < area.y1; ++y) {
    float* row = height.plane().row(y - area.y0);
    std::fill_n(row, area.width(), kNowhere_px);
    if (y < picture.y0 || y >= picture.y1) continue;
    for (int x = std::max(area.x0, picture.x0); x < std::min(area.x1, picture.x1); ++x)
      row[x - area.x0] = relief.z_px(x, y);
  }
  return height;
}

}  // namespace weft::solver
