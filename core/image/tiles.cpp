// SPDX-License-Identifier: Apache-2.0
#include "core/image/tiles.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace weft {

std::vector<Rect> tiles_of(Rect area, const TileOptions& options) {
  const int most = std::clamp(options.width, 1, std::max(area.width(), 1));
  const int width = (most + kRowGroup - 1) / kRowGroup * kRowGroup;
  const int height = std::clamp(options.height, 1, std::max(area.height(), 1));
  std::vector<Rect> tiles;
  for (int y = area.y0; y < area.y1; y += height) {
    for (int x = area.x0; x < area.x1; x += width) {
      tiles.push_back({x, y, std::min(x + width, area.x1), std::min(y + height, area.y1)});
    }
  }
  return tiles;
}

Result<void> for_each_tile(Rect area, const TileOptions& options, std::stop_token stop,
                           const std::function<void(Rect, int)>& body) {
  const std::vector<Rect> tiles = tiles_of(area, options);
  parallel_for(tiles.size(), options.threads, [&](std::size_t i, int worker) {
    if (!stop.stop_requested()) body(tiles[i], worker);
  });
  if (stop.stop_requested())
    return Error{ErrorKind::kInterrupted, "interrupted", "", "stopped on request", ""};
  return {};
}

}  // namespace weft
