// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/effects.h"

namespace weft::simulator {

Pass lambert_pass(const Scene& scene, const SceneRig& rig) {
  return {"lambert", "reflects light alike in all directions", PassStage::kLight,
          [unit = rig.signal_of_unit(scene.camera.iso)](PassTile& tile) {
            tile.signal_rect = tile.area;
            tile.signal.resize(tile.irradiance.size());
            if (tile.led == 0) return std::fill(tile.signal.begin(), tile.signal.end(), Rgb{});
            const Rgb flux = unit[static_cast<std::size_t>(tile.led - 1)];
            for (std::size_t i = 0; i < tile.signal.size(); ++i) {
              for (std::size_t c = 0; c < 3; ++c) {
                tile.signal[i][c] = tile.albedo[i][c] * tile.irradiance[i] * flux[c];
              }
            }
          }};
}

}  // namespace weft::simulator
