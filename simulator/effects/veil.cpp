// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/lens_veil.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "simulator/effects/effects.h"

namespace weft::simulator {
namespace {

constexpr int kMostLooked = 32;  // pixels of a cell, along a side, that its mean is taken from

/// The veils of a session, each found from its whole frame when the shot's first tile asks for it.
class Veils {
 public:
  Veils(const VeilSettings& settings, Size frame, PassList light)
      : settings_(settings), frame_(frame), light_(std::move(light)) {}

  Result<std::shared_ptr<const FrameLight>> of(const PassTile& tile) {
    const std::lock_guard lock(mutex_);
    const std::pair shot = {tile.take, tile.lit_together};
    const auto known = veils_.find(shot);
    if (known != veils_.end()) return known->second;
    const Result<FrameLight> light = light_of(tile);
    if (!light) return light.error();
    return veils_.emplace(shot, std::make_shared<const FrameLight>(veil_of(settings_, *light))).first->second;
  }

 private:
  Result<FrameLight> light_of(const PassTile& tile) const {
    PassList list = light_;
    list.lit_together = tile.lit_together;
    list.takes_before = tile.take - tile.shot;
    PassRunner runner(std::move(list), {.threads = 1});
    FrameLight light(frame_);
    for (int row = 0; row < light.rows(); ++row) {
      for (int column = 0; column < light.columns(); ++column) {
        const Result<void> ran = runner.run(
            looked_at(light.cell(column, row)), {&tile.shot, 1}, {}, [](const PassTile&) {},
            [&](const PassTile& part) { light.mean(column, row) = mean_of(part.signal); });
        if (!ran) return ran.error();
      }
    }
    return light;
  }

  static Rect looked_at(Rect cell) {
    const int width = std::min(cell.width(), kMostLooked), height = std::min(cell.height(), kMostLooked);
    const int x0 = cell.x0 + (cell.width() - width) / 2, y0 = cell.y0 + (cell.height() - height) / 2;
    return {x0, y0, x0 + width, y0 + height};
  }

  static Rgb mean_of(const std::vector<Rgb>& signal) {
    Rgb mean = {};
    for (const Rgb& light : signal)
      for (std::size_t c = 0; c < 3; ++c) mean[c] += light[c] / static_cast<double>(signal.size());
    return mean;
  }

  VeilSettings settings_;
  Size frame_;
  PassList light_;
  std::mutex mutex_;
  std::map<std::pair<int, std::vector<int>>, std::shared_ptr<const FrameLight>> veils_;
};

}  // namespace

Pass veil_pass(const Scene& scene, const SceneRig& rig, PassList light) {
  return {"veil", "adds the light that the lens spreads over the whole frame", PassStage::kShot,
          [veils = std::make_shared<Veils>(scene.camera.veil, rig.camera.size, std::move(light))](
              PassTile& tile) {
            const Result<std::shared_ptr<const FrameLight>> veil = veils->of(tile);
            if (!veil) {
              tile.failure = veil.error();
              return;
            }
            for_each_pixel(tile.signal_rect, [&](std::size_t i, int x, int y) {
              const Rgb added = (*veil)->at(x, y);
              for (std::size_t c = 0; c < 3; ++c) tile.signal[i][c] += added[c];
            });
          }};
}

}  // namespace weft::simulator
