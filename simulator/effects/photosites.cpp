// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/image/raw_frame.h"
#include "simulator/effects/effects.h"
#include "simulator/effects/random_key.h"

namespace weft::simulator {

Pass mosaic_pass(int halo_rows) {
  return {"mosaic", "keeps the colour that each photosite's filter passes", PassStage::kShot,
          [halo_rows](PassTile& tile) {
            constexpr CfaPattern kCfa;
            tile.sample_rect = grown_in_rows(tile.rect, halo_rows);
            tile.samples.resize(static_cast<std::size_t>(tile.sample_rect.pixels()));
            const std::size_t row = static_cast<std::size_t>(tile.sample_rect.width());
            for (int y = tile.sample_rect.y0, j = 0; y < tile.sample_rect.y1; ++y, ++j) {
              const Rgb* signal = &tile.signal[index_in(tile.signal_rect, tile.sample_rect.x0, y)];
              double* samples = &tile.samples[static_cast<std::size_t>(j) * row];
              for (std::size_t i = 0; i < row; ++i) {
                const int x = tile.sample_rect.x0 + static_cast<int>(i);
                samples[i] = signal[i][static_cast<std::size_t>(kCfa.channel_at(x, y))];
              }
            }
          }};
}

Pass rgb_pass() {
  return {"rgb", "keeps all three colours of each pixel", PassStage::kShot, [](PassTile& tile) {
            tile.sample_rect = tile.rect;
            tile.samples.clear();
            for_each_pixel(tile.rect, [&](std::size_t, int x, int y) {
              const Rgb& s = tile.signal[index_in(tile.signal_rect, x, y)];
              tile.samples.insert(tile.samples.end(), s.begin(), s.end());
            });
          }};
}

Pass noise_pass(const Scene& scene, const SceneRig& rig) {
  return {"noise", "draws photons (Poisson) and read noise (normal)", PassStage::kShot,
          [sensor = rig.sensor, key = random_key(scene)](PassTile& tile) {
            const std::size_t channels =
                tile.samples.size() / static_cast<std::size_t>(tile.sample_rect.pixels());
            for_each_pixel(tile.sample_rect, [&](std::size_t i, int x, int y) {
              for (std::size_t c = 0; c < channels; ++c) {
                double& sample = tile.samples[channels * i + c];
                sample = noisy(sensor, sample,
                               philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                       static_cast<std::uint32_t>(tile.take), static_cast<std::uint32_t>(c)},
                                      key));
              }
            });
          }};
}

Pass converter_pass(const SceneRig& rig) {
  return {"converter", "adds the black level, rounds to whole counts and clips at 0 and white",
          PassStage::kShot, [sensor = rig.sensor](PassTile& tile) {
            tile.counts.resize(tile.samples.size());
            for (std::size_t i = 0; i < tile.counts.size(); ++i)
              tile.counts[i] = count_of(sensor, tile.samples[i]);
          }};
}

}  // namespace weft::simulator
