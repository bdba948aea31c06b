// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <new>
#include <numeric>
#include <utility>

#include "simulator/build_passes.h"
#include "simulator/frame_parts.h"
#include "simulator/simulate.h"

namespace weft::simulator {
namespace {

constexpr int kFarthestPixel = 1000 * 1000;

}  // namespace

Result<Rendering> render_readings(const Scene& scene, Rect area, const TileOptions& tiles) try {
  const Result<SimulationPlan> plan = plan_of(scene);
  if (!plan) return plan.error();
  const auto inside = [](int from, int to) {
    return from >= -kFarthestPixel && to <= kFarthestPixel && from < to;
  };
  if (!inside(area.x0, area.x1) || !inside(area.y0, area.y1)) {
    return Error{ErrorKind::kUsage, "area cannot be rendered",
                 fmt::format("columns {} to {}, rows {} to {}", area.x0, area.x1, area.y0, area.y1),
                 fmt::format("it must hold a pixel and end within {} pixels of the origin", kFarthestPixel),
                 "choose another area"};
  }
  Result<PassList> surface = build_passes(plan->scene, plan->rig, Output::kSurface);
  Result<PassList> frames = build_passes(plan->scene, plan->rig, Output::kRgb);
  if (!surface) return surface.error();
  if (!frames) return frames.error();
  std::vector<int> leds(plan->rig.leds.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  const std::uint64_t planes = 3 * leds.size() + kTruthPlanes;
  if (Result<void> ok = check_memory(static_cast<std::uint64_t>(area.pixels()) * planes * sizeof(double));
      !ok) {
    return ok.error();
  }
  const Size size = {area.width(), area.height()};
  Rendering out = {Image<double>(size, 3 * static_cast<int>(leds.size())), Image<double>(size, 3),
                   Image<double>(size, 3), Image<double>(size)};
  const auto put = [&](const PassTile& tile, View<double> plane, const auto& value_of) {
    for_each_pixel(tile.rect,
                   [&](std::size_t i, int x, int y) { plane(x - area.x0, y - area.y0) = value_of(i); });
  };
  const Result<void> truth =
      PassRunner(std::move(*surface), tiles)
          .run(area, {}, {},
               [&](const PassTile& tile) {
                 put(tile, out.normal.plane(0), [&](std::size_t i) { return tile.surface[i].normal.x; });
                 put(tile, out.normal.plane(1), [&](std::size_t i) { return tile.surface[i].normal.y; });
                 put(tile, out.normal.plane(2), [&](std::size_t i) { return tile.surface[i].normal.z; });
                 put(tile, out.height_mm.plane(), [&](std::size_t i) { return tile.surface[i].height_mm; });
                 for (std::size_t c = 0; c < 3; ++c) {
                   put(tile, out.albedo.plane(static_cast<int>(c)),
                       [&](std::size_t i) { return tile.albedo[i][c]; });
                 }
               },
               {});
  if (!truth) return truth.error();
  const double exposure = plan->rig.exposure(scene.camera.iso);
  const Result<void> ran = PassRunner(std::move(*frames), tiles)
                               .run(
                                   area, leds, {}, [](const PassTile&) {},
                                   [&](const PassTile& tile) {
                                     for (std::size_t c = 0; c < 3; ++c) {
                                       put(tile, out.readings.plane(3 * (tile.led - 1) + static_cast<int>(c)),
                                           [&](std::size_t i) { return tile.samples[3 * i + c] / exposure; });
                                     }
                                   });
  if (!ran) return ran.error();
  return out;
} catch (const std::bad_alloc&) {
  return no_memory("the system refused some");
}

}  // namespace weft::simulator
