// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "simulator/effects/effects.h"
#include "simulator/effects/transport.h"
#include "simulator/transport/shadows.h"

namespace weft::simulator {

Pass mesh_pass() {
  return {"mesh", "makes the cloth's height field ready for rays", PassStage::kSurface, [](PassTile& tile) {
            Result<HeightMesh> mesh = HeightMesh::build(tile.area, tile.point_mm);
            if (!mesh) {
              tile.failure = mesh.error();
              return;
            }
            tile.transport = std::make_shared<Transport>(Transport{std::move(*mesh), std::nullopt});
          }};
}

Pass cast_shadows_pass(const Scene& scene, const SceneRig& rig, const Halos& halos) {
  RaySettings settings;
  settings.rays = scene.effects.finite_led ? scene.transport.shadow_rays : 1;
  settings.reach_mm = halos.shadow_mm;
  settings.seed = static_cast<std::uint64_t>(scene.seed);
  const double radius_mm = scene.effects.finite_led ? scene.lights.led_radius_mm : 0;
  return {"cast shadows", "takes from each point the share of the LED that the cloth hides",
          PassStage::kLight,
          [leds = rig.leds.leds, settings, radius_mm, halo = halos.of_light()](PassTile& tile) {
            tile.visibility.assign(tile.irradiance.size(), 1);
            if (tile.led == 0 || tile.failure) return;
            const NearLight& led = leds[static_cast<std::size_t>(tile.led - 1)];
            RaySettings of_led = settings;
            of_led.stream = static_cast<std::uint32_t>(tile.led);
            const Rect pixels = grown(tile.rect, halo);
            const Result<Image<float>> visible =
                visible_fraction(tile.transport->mesh, pixels, {led.position_mm, radius_mm}, of_led);
            if (!visible) {
              tile.failure = visible.error();
              return;
            }
            for_each_pixel(pixels, [&](std::size_t, int x, int y) {
              const std::size_t i = index_in(tile.area, x, y);
              if (!tile.target.empty() && tile.target[i] != kCloth) return;
              tile.visibility[i] = (*visible)(x - pixels.x0, y - pixels.y0);
              tile.irradiance[i] *= static_cast<double>(tile.visibility[i]);
            });
          }};
}

}  // namespace weft::simulator
