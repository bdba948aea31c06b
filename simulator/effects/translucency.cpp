// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "simulator/effects/effects.h"
#include "simulator/transport/diffusion.h"

namespace weft::simulator {
namespace {

/// Yarns that carry light alike far.
struct Carrier {
  Diffusion diffusion;
  std::array<double, 2> shares;  ///< of the light that enters the warp, and the weft
};

std::vector<Carrier> carriers_of(const Scene& scene) {
  const double px_per_mm = 1 / mm_per_pixel_of_cloth(scene);
  const auto [warp, weft] = scene.material.translucency.yarns();
  std::vector<Carrier> carriers;
  if (warp.mean_mm == weft.mean_mm && warp.share > 0 && weft.share > 0)
    return {{Diffusion(warp.mean_mm * px_per_mm), {warp.share, weft.share}}};
  if (warp.share > 0) carriers.push_back({Diffusion(warp.mean_mm * px_per_mm), {warp.share, 0}});
  if (weft.share > 0) carriers.push_back({Diffusion(weft.mean_mm * px_per_mm), {0, weft.share}});
  return carriers;
}

/// The share of the light at a point that enters there; paper lets none in.
double share_at(const PassTile& tile, std::size_t i, const std::array<double, 2>& shares) {
  if (!tile.target.empty() && tile.target[i] != kCloth) return 0;
  return shares[tile.surface[i].yarn.is_weft];
}

/// What falls on a point: by the LED, and by way of the cloth.
double light_at(const PassTile& tile, std::size_t i, std::size_t c) {
  return tile.irradiance[i] + (tile.indirect.empty() ? 0 : tile.indirect[i][c]);
}

/// What leaves each point of `out_rect` that had entered elsewhere, of one channel.
std::vector<double> left_of(const PassTile& tile, const std::vector<Carrier>& carriers, Rect out_rect,
                            std::size_t c) {
  std::vector<double> left(static_cast<std::size_t>(out_rect.pixels())), entered;
  for (const Carrier& carrier : carriers) {
    entered.clear();
    for_each_pixel(grown(out_rect, carrier.diffusion.radius()), [&](std::size_t, int x, int y) {
      const std::size_t i = index_in(tile.area, x, y);
      entered.push_back(share_at(tile, i, carrier.shares) * light_at(tile, i, c));
    });
    carrier.diffusion.add(entered, out_rect, left);
  }
  return left;
}

}  // namespace

Pass translucency_pass(const Scene& scene, const SceneRig& rig, const Halos& halos) {
  const auto [warp, weft] = scene.material.translucency.yarns();
  return {"translucency", "lets light enter a yarn and leave beside it", PassStage::kLight,
          [carriers = carriers_of(scene), shares = std::array{warp.share, weft.share},
           unit = rig.signal_of_unit(scene.camera.iso), halo = halos.of_signal()](PassTile& tile) {
            if (tile.led == 0 || tile.failure) return;
            const Rect out_rect = grown(tile.rect, halo);
            const Rgb flux = unit[static_cast<std::size_t>(tile.led - 1)];
            std::vector<double> left;
            for (std::size_t c = 0; c < 3; ++c) {
              if (c == 0 || !tile.indirect.empty()) left = left_of(tile, carriers, out_rect, c);
              for_each_pixel(out_rect, [&](std::size_t j, int x, int y) {
                const std::size_t i = index_in(tile.area, x, y);
                if (!tile.target.empty() && tile.target[i] != kCloth) return;
                const double gained = left[j] - share_at(tile, i, shares) * light_at(tile, i, c);
                double& signal = tile.signal[i][c];
                signal = std::max(signal + tile.albedo[i][c] * gained * flux[c], 0.0);
              });
            }
          }};
}

}  // namespace weft::simulator
