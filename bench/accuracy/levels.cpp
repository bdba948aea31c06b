// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <utility>

#include "bench/accuracy/contenders.h"
#include "bench/accuracy/scenes.h"
#include "bench/base/rig.h"
#include "bench/base/yardsticks.h"
#include "core/job.h"
#include "core/parallel.h"

namespace weft::bench {
namespace {

// Of a weave and a material each.
const std::vector<std::string> kCloths = {"smooth lambert", "plain white", "deep lambert",
                                          "plain dark-satin"};

Result<std::vector<const solver::MethodName*>> levels_of(const std::vector<std::string>& names) {
  if (names.empty()) return levels_of({"standard", "robust", "reference"});
  std::vector<const solver::MethodName*> levels;
  for (const std::string& name : names) {
    const solver::MethodName* level = solver::find_method(name);
    if (level == nullptr || level->extent == solver::Extent::kHalfSize)
      return no_such("level of whole frames", name, {"fast", "standard", "robust", "reference"});
    levels.push_back(level);
  }
  return levels;
}

Result<Patch> frame_of_cloth(const std::string& name, Size size, int threads) {
  AccuracyTableOptions chosen;
  chosen.scene = name;
  const Result<std::vector<AccuracyScene>> cloth = chosen_scenes(chosen);
  if (!cloth) return cloth.error();
  simulator::Scene scene = cloth->front().scene;
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  return render_patch(scene, {0, 0, size.width, size.height}, threads);
}

Json said_of(const pipeline::FrameFacts& facts) {
  Json row = Json::object();
  if (facts.gloss) {
    const solver::MeasuredLobe& lobe = facts.gloss->lobes.front();
    row["said"] = lobe.is_measured() ? name_of(lobe.lobe.family) : name_of(lobe.refusal);
  }
  if (!facts.reference) return row;
  const pipeline::LightStages& stages = facts.reference->stages;
  row["stages"] = std::string(stages.shadows ? "shadows " : "") + (stages.interreflection ? "bounces" : "");
  row["rounds"] = facts.reference->rounds.size();
  return row;
}

}  // namespace

/// What levels take on whole frames in memory, of held-out cloths (bench/accuracy/scenes.h).
/// Rendering a megapixel takes up to a minute.
/// s: wall time of one solve, the search for a lobe in it, which is lobe_s. ns_per_pixel: of s.
/// ratio_to_unpack: of that to LibRaw's unpacking of four megapixels, as of accuracy_table(). said: of the
/// lobe. stages, rounds: of `reference`, what its last solve took out, and how often light was traced.
Result<Rows> level_speed(const AccuracyTableOptions& options) {
  const int threads = resolved_threads(options.threads);
  const Size size = bench_size(options.megapixels);
  const Result<Yardsticks> yardsticks = measure_yardsticks(threads);
  if (!yardsticks) return yardsticks.error();
  const Result<std::vector<const solver::MethodName*>> levels = levels_of(options.methods);
  if (!levels) return levels.error();
  Rows rows;
  const std::vector<std::string> cloths = options.scene.empty() ? kCloths : std::vector{options.scene};
  for (const std::string& cloth : cloths) {
    const Result<Patch> frame = frame_of_cloth(cloth, size, threads);
    if (!frame) return frame.error();
    for (const solver::MethodName* level : *levels) {
      SolvedMaps maps(size);
      Stopwatch watch;
      const auto facts = solve_level(frame->photographs, *level, threads, maps);
      if (!facts) return facts.error();
      const double seconds = watch.lap(), a_pixel = seconds / static_cast<double>(size.pixels());
      Json& row = rows.emplace_back(Json{{"cloth", cloth},
                                         {"level", level->name},
                                         {"megapixels", static_cast<double>(size.pixels()) * 1e-6},
                                         {"threads", threads},
                                         {"s", seconds},
                                         {"lobe_s", maps.lobe_seconds},
                                         {"ns_per_pixel", a_pixel * 1e9},
                                         {"ratio_to_unpack", a_pixel / yardsticks->unpack_seconds_a_pixel}});
      row.update(said_of(*facts));
    }
  }
  return rows;
}

}  // namespace weft::bench
