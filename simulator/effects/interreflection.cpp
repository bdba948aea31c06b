// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "simulator/effects/effects.h"
#include "simulator/effects/transport.h"

namespace weft::simulator {

Pass bounces_pass(const Scene& scene, const Halos& halos) {
  RaySettings settings;
  settings.rays = scene.transport.bounce_rays;
  settings.reach_mm = halos.bounce_mm;
  settings.seed = static_cast<std::uint64_t>(scene.seed);
  settings.stream = kBounceStream;
  const int halo = halos.of_entered() + (halos.bounces - 1) * halos.bounce;
  return {"bounces", "follows light from cloth to cloth, once for all LEDs", PassStage::kSurface,
          [settings, halo](PassTile& tile) {
            if (tile.failure) return;
            std::vector<Vec3> normals(tile.surface.size());
            std::transform(tile.surface.begin(), tile.surface.end(), normals.begin(),
                           [](const SurfacePoint& point) { return point.normal; });
            Result<Bounces> bounces =
                Bounces::trace(tile.transport->mesh, normals, grown(tile.rect, halo), settings);
            if (!bounces) {
              tile.failure = bounces.error();
              return;
            }
            const Image<float> openness = bounces->openness();
            tile.openness.assign(tile.surface.size(), 1);
            const Rect traced = bounces->pixels();
            for_each_pixel(traced, [&](std::size_t, int x, int y) {
              tile.openness[index_in(tile.area, x, y)] =
                  static_cast<double>(openness(x - traced.x0, y - traced.y0));
            });
            tile.transport->bounces = std::move(*bounces);
          }};
}

Pass interreflection_pass(const Scene& scene, const SceneRig& rig) {
  return {"interreflection", "adds the light that reaches each point by way of the cloth", PassStage::kLight,
          [unit = rig.signal_of_unit(scene.camera.iso), bounces = scene.transport.bounces](PassTile& tile) {
            tile.indirect.assign(tile.irradiance.size(), Rgb{});
            if (tile.led == 0 || tile.failure) return;
            std::vector<Rgb> direct(tile.irradiance.size());
            for (std::size_t i = 0; i < direct.size(); ++i) direct[i].fill(tile.irradiance[i]);
            Result<std::vector<Rgb>> indirect =
                tile.transport->bounces->gather_bounces(direct, tile.albedo, bounces);
            if (!indirect) {
              tile.failure = indirect.error();
              return;
            }
            tile.indirect = std::move(*indirect);
            const Rgb flux = unit[static_cast<std::size_t>(tile.led - 1)];
            for (std::size_t i = 0; i < tile.signal.size(); ++i) {
              if (!tile.target.empty() && tile.target[i] != kCloth) tile.indirect[i] = {};
              for (std::size_t c = 0; c < 3; ++c) {
                tile.signal[i][c] += tile.albedo[i][c] * tile.indirect[i][c] * flux[c];
              }
            }
          }};
}

}  // namespace weft::simulator
