// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/defects.h"

#include "core/image/raw_frame.h"
#include "simulator/camera/saturation.h"
#include "simulator/effects/effects.h"
#include "simulator/effects/random_key.h"

namespace weft::simulator {

Pass photosites_pass(const Scene& scene, const Halos& halos) {
  return {"photosites", "draws how each photosite differs from the next", PassStage::kSurface,
          [pattern = SensorPattern(defects_of(scene), random_key(scene)),
           rows = halos.bloom_rows](PassTile& tile) {
            const Rect rect = grown_in_rows(tile.rect, rows);
            tile.photosites.resize(static_cast<std::size_t>(rect.pixels()));
            pattern.fill(rect, tile.photosites);
          }};
}

Pass expose_pass(const SceneRig& rig) {
  const double exposure_s = rig.exposure_us * 1e-6;
  return {"exposure", "fills photosites by their own response and by warmth", PassStage::kShot,
          [exposure_s, electrons = rig.sensor.electrons_at_white](PassTile& tile) {
            expose(tile.photosites, exposure_s, electrons, tile.samples);
          }};
}

Pass bloom_pass(const Scene& scene) {
  return {"bloom", "spills the charge of full photosites into their column", PassStage::kShot,
          [kernel = bloom_kernel(scene.camera.bloom)](PassTile& tile) {
            std::vector<double> kept(static_cast<std::size_t>(tile.rect.pixels()));
            bloom(kernel, 1, tile.samples, tile.rect, kept);
            tile.samples = std::move(kept);
            tile.sample_rect = tile.rect;
          }};
}

Pass nonlinearity_pass(const Scene& scene) {
  return {"nonlinearity", "bends the line from light to counts", PassStage::kShot,
          [bend = *NonLinearity::of(scene.camera.linearity)](PassTile& tile) {
            for (double& sample : tile.samples) sample = bend.distorted(sample);
          }};
}

Pass black_pattern_pass(const SceneRig& rig) {
  return {"black pattern", "adds what columns and photosites store without light", PassStage::kShot,
          [counts = rig.sensor.white - rig.sensor.black](PassTile& tile) {
            const std::size_t rows_above =
                (tile.photosites.size() - tile.samples.size()) / 2;  // bloom has used its halo up
            add_black_pattern(std::span(tile.photosites).subspan(rows_above, tile.samples.size()), counts,
                              tile.samples);
          }};
}

}  // namespace weft::simulator
