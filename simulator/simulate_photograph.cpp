// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "simulator/build_passes.h"
#include "simulator/frame_parts.h"
#include "simulator/simulate.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;

Result<void> check_leds(const std::vector<int>& lit, int leds) {
  for (std::size_t i = 0; i < lit.size(); ++i) {
    const bool is_there = lit[i] > 0 && lit[i] <= leds;
    if (is_there && std::find(lit.begin(), lit.begin() + static_cast<std::ptrdiff_t>(i), lit[i]) ==
                        lit.begin() + static_cast<std::ptrdiff_t>(i))
      continue;
    return Error{ErrorKind::kUsage, is_there ? "a LED is named twice" : "the scene has no such LED",
                 fmt::format("LED {}", lit[i]),
                 fmt::format("LEDs are numbered from 1 to {}; 0 is the dark shot", leds), "choose another"};
  }
  return {};
}

}  // namespace

Result<void> simulate_frame(const Scene& scene, int led, const fs::path& file,
                            const SimulateOptions& options) {
  const std::vector<int> leds = led == 0 ? std::vector<int>() : std::vector<int>{led};
  return simulate_photograph(scene, {leds, {}}, file, options);
}

Result<void> simulate_photograph(const Scene& scene, const PhotographSettings& photograph,
                                 const fs::path& file, const SimulateOptions& options) try {
  const Result<SimulationPlan> plan = plan_of(scene);
  if (!plan) return plan.error();
  if (plan->scene.frames == FrameFormat::kExr) {
    return Error{ErrorKind::kUsage, "one frame alone is a raw file", "frames", "the scene's frames are EXR",
                 "simulate the whole session, or set frames = \"dng\""};
  }
  if (Result<void> ok = check_leds(photograph.leds, static_cast<int>(plan->rig.leds.leds.size())); !ok)
    return ok;
  SceneRig rig = plan->rig;
  const double exposure_us = photograph.exposure_us.value_or(rig.exposure_us);
  if (exposure_us != rig.exposure_us)
    rig.exposure_us = exposure_us * (1 + scene.camera.retakes.shutter_error);
  Result<PassList> passes = build_passes(plan->scene, rig, Output::kCounts);
  if (!passes) return passes.error();
  passes->lit_together = photograph.leds;
  passes->takes_before = options.takes_before;
  const int shot = photograph.leds.empty() ? 0 : photograph.leds.front();
  RawFrame frame = frame_head(*plan, exposure_us);
  const Size size = rig.camera.size;
  if (Result<void> ok = check_memory(2 * sizeof(std::uint16_t) * static_cast<std::uint64_t>(size.pixels()));
      !ok) {
    return ok;
  }
  frame.counts = Image<std::uint16_t>(size);
  PassRunner runner(std::move(*passes), options.tiles);
  Result<void> ran = runner.run(
      {0, 0, size.width, size.height}, {&shot, 1}, options.stop, [](const PassTile&) {},
      [&](const PassTile& tile) { copy_counts(tile, 0, frame.counts.plane()); });
  if (!ran) return ran;
  return write_dng(file, frame, tags_of(plan->scene));
} catch (const std::bad_alloc&) {
  return no_memory("the system refused some");
}

}  // namespace weft::simulator
