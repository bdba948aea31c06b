// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"
#include "simulator/geometry/scene_surface.h"

namespace weft::simulator {

Pass geometry_pass(const Scene& scene) {
  const auto pass = [](const auto& surface) {
    return [surface](PassTile& tile) {
      for (std::size_t i = 0; i < tile.surface.size(); ++i) {
        tile.surface[i] = surface.at(tile.point_mm[i].x, tile.point_mm[i].y);
      }
    };
  };
  return {"geometry", "gives the cloth its height, normal and yarn in closed form", PassStage::kSurface,
          std::visit([&](const auto& surface) -> std::function<void(PassTile&)> { return pass(surface); },
                     surface_of(scene.geometry))};
}

Pass relief_pass() {
  return {"relief", "lifts each point from the plane to the cloth's height", PassStage::kSurface,
          [](PassTile& tile) {
            for (std::size_t i = 0; i < tile.surface.size(); ++i)
              tile.point_mm[i].z += tile.surface[i].height_mm;
          }};
}

}  // namespace weft::simulator
