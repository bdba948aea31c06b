// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/optics.h"

#include "simulator/effects/effects.h"

namespace weft::simulator {
namespace {

std::span<const double> numbers_of(const std::vector<Rgb>& signal) {
  return {signal.front().data(), 3 * signal.size()};
}
std::span<double> numbers_of(std::vector<Rgb>& signal) {
  return {signal.front().data(), 3 * signal.size()};
}

std::vector<Rgb> cropped(const std::vector<Rgb>& signal, Rect from, Rect to) {
  std::vector<Rgb> part;
  part.reserve(static_cast<std::size_t>(to.pixels()));
  for (int y = to.y0; y < to.y1; ++y) {
    const auto row = signal.begin() + static_cast<std::ptrdiff_t>(index_in(from, to.x0, y));
    part.insert(part.end(), row, row + to.width());
  }
  return part;
}

}  // namespace

Pass vignetting_pass(const Scene& scene, const SceneRig& rig) {
  return {"vignetting", "darkens the frame towards its corners", PassStage::kShot,
          [vignette = Vignette(scene.camera.vignette, rig.camera)](PassTile& tile) {
            for_each_pixel(tile.signal_rect, [&](std::size_t i, int x, int y) {
              const double gain = vignette.gain(x, y);
              for (double& s : tile.signal[i]) s *= gain;
            });
          }};
}

Pass defocus_pass(const Scene& scene, const Halos& halos) {
  return {
      "defocus", "blurs by a disc and by the lens's point spread", PassStage::kShot,
      [kernel = blur_kernel(scene.camera.blur), halo = halos.bloom_rows + halos.chromatic](PassTile& tile) {
        const Rect sharp_rect = grown(tile.rect, halo + kernel.radius);
        const std::vector<Rgb> sharp = cropped(tile.signal, tile.signal_rect, sharp_rect);
        tile.signal_rect = grown(tile.rect, halo);
        tile.signal.resize(static_cast<std::size_t>(tile.signal_rect.pixels()));
        convolve(kernel, numbers_of(sharp), tile.signal_rect, 3, numbers_of(tile.signal));
      }};
}

}  // namespace weft::simulator
