// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"

namespace weft::simulator {

Pass camera_pass(const Scene& scene, const Rig&) {
  return {"camera", "finds the point of the cloth's plane that each pixel sees", Stage::kSurface,
          [scene](Tile& tile) {
            for_each_pixel(tile.area, [&](std::size_t i, int x, int y) {
              tile.point_mm[i] = point_of_pixel(scene, x, y);
            });
          }};
}

}  // namespace weft::simulator
