// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/cloth_movement.h"

#include "simulator/effects/effects.h"
#include "simulator/effects/random_key.h"

namespace weft::simulator {

Pass onto_moved_cloth_pass(const Scene& scene) {
  return {"movement", "shifts and turns the cloth a little for each shot", PassStage::kSurface,
          [settings = scene.camera.movement, key = random_key(scene)](PassTile& tile) {
            const ClothMovement movement = movement_of_shot(settings, tile.take, key);
            for (Vec3& point : tile.point_mm) point = movement.on_cloth(point);
          }};
}

Pass back_from_moved_cloth_pass(const Scene& scene) {
  return {"moved back", "brings points and normals of the moved cloth back to the rig", PassStage::kSurface,
          [settings = scene.camera.movement, key = random_key(scene)](PassTile& tile) {
            const ClothMovement m = movement_of_shot(settings, tile.take, key);
            for (std::size_t i = 0; i < tile.surface.size(); ++i) {
              Vec3& point = tile.point_mm[i];
              const Vec3 shift = {m.x_mm, m.y_mm, 0};
              point = m.turned(point) + shift;
              SurfacePoint& surface = tile.surface[i];
              surface.normal = m.turned(surface.normal);
              const Vec3 along = m.turned({surface.along_x, surface.along_y, 0});
              surface.along_x = along.x;
              surface.along_y = along.y;
            }
          }};
}

}  // namespace weft::simulator
