// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/print.h"

#include "simulator/effects/effects.h"

namespace weft::simulator {

Pass print_pass(const Scene& scene) {
  return {"print", "multiplies the albedo by the printed pattern", PassStage::kSurface,
          [print = Print(scene.material.print)](PassTile& tile) {
            for (std::size_t i = 0; i < tile.albedo.size(); ++i) {
              const auto ink = print.at(tile.point_mm[i].x, tile.point_mm[i].y);
              if (!ink) continue;
              for (std::size_t c = 0; c < 3; ++c) tile.albedo[i][c] *= (*ink)[c];
            }
          }};
}

}  // namespace weft::simulator
