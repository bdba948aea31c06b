// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/lateral_colour.h"
#include "simulator/effects/effects.h"

namespace weft::simulator {

Pass chromatic_aberration_pass(const Scene& scene, const SceneRig& rig, const Halos& halos) {
  return {
      "lateral colour", "shows red and blue at another scale than green", PassStage::kShot,
      [lens = LateralColour(scene.camera.chromatic, rig.camera), halo = halos.bloom_rows](PassTile& tile) {
        const Rect shown_rect = grown(tile.rect, halo);
        std::vector<Rgb> shown(static_cast<std::size_t>(shown_rect.pixels()));
        lens.image(tile.signal, tile.signal_rect, shown_rect, shown);
        tile.signal = std::move(shown);
        tile.signal_rect = shown_rect;
      }};
}

}  // namespace weft::simulator
