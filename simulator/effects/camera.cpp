// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"

namespace weft::simulator {

Pass camera_pass(const Scene& scene, const SceneRig& rig) {
  constexpr const char* kDoes = "finds the point of the cloth's plane that each pixel sees";
  if (!rig.lens) {
    return {"camera", kDoes, PassStage::kSurface, [scene](PassTile& tile) {
              for_each_pixel(tile.area, [&](std::size_t i, int x, int y) {
                tile.point_mm[i] = point_of_pixel(scene, x, y);
              });
            }};
  }
  return {scene.effects.distortion ? "distortion" : "camera",
          scene.effects.distortion ? "finds the point that each pixel sees through the bent rays of the lens"
                                   : kDoes,
          PassStage::kSurface,
          [lens = *rig.lens, height_mm = scene.geometry.cloth_height_mm](PassTile& tile) {
            for_each_pixel(tile.area, [&](std::size_t i, int x, int y) {
              tile.point_mm[i] = lens.point_on_plane(x, y, height_mm);
            });
          }};
}

}  // namespace weft::simulator
