// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/passes.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"

namespace weft::simulator {
namespace {

using std::chrono::steady_clock;

// What a halo costs falls with the size of the tile, which memory limits.
constexpr int kSquareTile = 256;
constexpr int kLargeTile = 512;
constexpr int kLargeHalo = 64;

}  // namespace

void PassTile::resize(Rect tile, int halo) {
  rect = tile;
  area = grown(tile, halo);
  const auto pixels = static_cast<std::size_t>(area.pixels());
  point_mm.resize(pixels);
  surface.resize(pixels);
  albedo.resize(pixels);
  transport.reset();
  light.resize(pixels);
  irradiance.resize(pixels);
}

PassRunner::PassRunner(PassList list, TileOptions options)
    : list_(std::move(list)),
      options_(options),
      workers_(static_cast<std::size_t>(resolved_threads(options.threads))) {
  if (list_.halo > 0) {
    const int side = list_.halo > kLargeHalo ? kLargeTile : kSquareTile;
    options_.width = std::min(options_.width, side);
    options_.height = std::max(options_.height, side);
  }
  for (Worker& worker : workers_) {
    worker.spent.resize(list_.passes.size());
    worker.pixels.resize(list_.passes.size());
    worker.tile.lit_together = list_.lit_together;
  }
}

void PassRunner::run_stage(PassStage stage, Worker& worker) const {
  for (std::size_t p = 0; p < list_.passes.size(); ++p) {
    if (list_.passes[p].stage != stage) continue;
    const steady_clock::time_point start = steady_clock::now();
    list_.passes[p].run(worker.tile);
    worker.spent[p] += steady_clock::now() - start;
    worker.pixels[p] += worker.tile.rect.pixels();
  }
}

void PassRunner::light(Worker& worker) const {
  PassTile& tile = worker.tile;
  const bool one_each = tile.shot <= list_.leds || list_.leds == 0;
  tile.led = one_each ? tile.shot : (tile.shot - 1) % list_.leds + 1;
  if (list_.lit_together.empty()) return run_stage(PassStage::kLight, worker);
  worker.sum.assign(static_cast<std::size_t>(tile.area.pixels()), Rgb{});
  for (const int led : list_.lit_together) {
    tile.led = led;
    run_stage(PassStage::kLight, worker);
    for (std::size_t i = 0; i < worker.sum.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) worker.sum[i][c] += tile.signal[i][c];
    }
  }
  tile.signal.swap(worker.sum);
}

Result<void> PassRunner::run(Rect area, std::span<const int> shots, std::stop_token stop,
                             const std::function<void(const PassTile&)>& with_surface,
                             const std::function<void(const PassTile&)>& with_shot) {
  // The tile loop starts at column 0, an area anywhere.
  const Rect whole = {0, 0, area.width(), area.height()};
  Result<void> done = for_each_tile(whole, options_, std::move(stop), [&](Rect part, int w) {
    Worker& worker = workers_[static_cast<std::size_t>(w)];
    PassTile& tile = worker.tile;
    if (tile.failure) return;
    tile.resize({area.x0 + part.x0, area.y0 + part.y0, area.x0 + part.x1, area.y0 + part.y1}, list_.halo);
    tile.shot = tile.led = 0;
    if (!list_.cloth_moves) run_stage(PassStage::kSurface, worker);
    with_surface(tile);
    for (const int shot : shots) {
      tile.shot = shot;
      tile.take = list_.takes_before + shot;
      if (list_.cloth_moves) run_stage(PassStage::kSurface, worker);
      light(worker);
      run_stage(PassStage::kShot, worker);
      if (!tile.failure) with_shot(tile);
    }
  });
  for (const Worker& worker : workers_) {
    if (worker.tile.failure) return *worker.tile.failure;
  }
  return done;
}

std::int64_t PassRunner::pixels_with_halos(Rect area) const {
  std::int64_t pixels = 0;
  for (const Rect tile : tiles_of(area, options_)) pixels += grown(tile, list_.halo).pixels();
  return pixels;
}

std::vector<PassCost> PassRunner::costs() const {
  std::vector<PassCost> costs;
  for (std::size_t p = 0; p < list_.passes.size(); ++p) {
    const Pass& pass = list_.passes[p];
    PassCost cost = {pass.name, pass.does, pass.effect};
    for (const Worker& worker : workers_) {
      cost.seconds += std::chrono::duration<double>(worker.spent[p]).count();
      cost.pixels += worker.pixels[p];
    }
    costs.push_back(std::move(cost));
  }
  return costs;
}

}  // namespace weft::simulator
