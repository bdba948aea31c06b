// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/field_curvature.h"

#include "simulator/effects/effects.h"

namespace weft::simulator {

Pass field_curvature_pass(const Scene& scene, const SceneRig& rig, const Halos& halos) {
  return {"field curvature", "blurs by a disc that grows towards the corners", PassStage::kShot,
          [field = FieldCurvature(scene.camera.field, rig.camera),
           halo = halos.of_signal() - halos.field](PassTile& tile) {
            const Rect blurred_rect = grown(tile.rect, halo);
            std::vector<Rgb> blurred(static_cast<std::size_t>(blurred_rect.pixels()));
            field.blur(tile.signal, tile.signal_rect, blurred_rect, blurred);
            tile.signal = std::move(blurred);
            tile.signal_rect = blurred_rect;
          }};
}

}  // namespace weft::simulator
