// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bench/accuracy/accuracy_scenes.h"
#include "bench/accuracy/score.h"
#include "bench/base/bound.h"
#include "bench/base/measured_rig.h"
#include "bench/base/yardsticks.h"
#include "core/base/job_context.h"
#include "core/base/parallel.h"
#include "core/solve/solve_record.h"
#include "simulator/camera/sensor.h"
#include "simulator/scene/scene_rig.h"
#include "solve/levels/stages.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

// Marks, among the rows of one scene, those that no other beats in both time and error.
void mark_frontier(Rows& rows, const std::vector<Contender>& all) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    bool beaten = false;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (all[j].is_yardstick || i == j) continue;
      const double slower = number(rows[i], "ns_per_pixel") - number(rows[j], "ns_per_pixel");
      const double farther = number(rows[i], "mean_deg") - number(rows[j], "mean_deg");
      beaten |= slower >= 0 && farther >= 0 && slower + farther > 0;
    }
    rows[i]["pareto"] = all[i].is_yardstick ? Json() : Json(!beaten);
  }
}

// Bytes that a method reads and writes a pixel: its readings; normal, albedo and its sigma, sigma, residual
// and status.
double bytes_a_pixel(const Contender& contender) {
  constexpr double kLights = 10;
  return 4 * (kLights * contender.planes + 3 + 2 * contender.planes + 2) + 2;
}

// What compares the rows of one scene with each other and with the yardsticks.
void compare(Rows& rows, const std::vector<Contender>& all, const std::optional<Yardsticks>& yardsticks) {
  const auto is_oracle = [](const Json& row) { return row["method"] == "oracle"; };
  const double oracle = number(*std::find_if(rows.begin(), rows.end(), is_oracle), "mean_deg");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i]["ratio_to_oracle"] = number(rows[i], "mean_deg") / oracle;
    if (!yardsticks) continue;
    const double seconds = number(rows[i], "ns_per_pixel") * 1e-9;
    rows[i]["ratio_to_unpack"] = seconds / yardsticks->unpack_seconds_a_pixel;
    rows[i]["ratio_to_copy"] = seconds / (yardsticks->copy_seconds_a_byte * bytes_a_pixel(all[i]));
  }
  mark_frontier(rows, all);
}

// The mean over scenes of each contender's rows.
Rows means_of(const std::vector<Rows>& scenes, const std::vector<Contender>& all) {
  Rows means;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<const Json*> rows;
    for (const Rows& scene : scenes) rows.push_back(&scene[i]);
    means.push_back(mean_row(rows));
    means.back()["scene"] = kAllScenes;
  }
  mark_frontier(means, all);
  return means;
}

}  // namespace

Result<std::vector<AccuracyScene>> chosen_scenes(const AccuracyTableOptions& options) {
  std::vector<AccuracyScene> scenes = accuracy_scenes(options.set, options.seed, options.quick), chosen;
  if (options.scene.empty()) return scenes;
  std::vector<std::string> names;
  for (AccuracyScene& scene : scenes) {
    names.push_back(scene.name);
    if (scene.name == options.scene) chosen.push_back(std::move(scene));
  }
  if (chosen.empty()) return no_such("scene", options.scene, names);
  return chosen;
}

Result<Rows> accuracy_table(const AccuracyTableOptions& options) {
  const Result<std::vector<AccuracyScene>> scenes = chosen_scenes(options);
  if (!scenes) return scenes.error();
  const Result<std::vector<Contender>> all = contenders_named(options.methods);
  if (!all) return all.error();
  const int threads = resolved_threads(options.threads);
  std::optional<Yardsticks> yardsticks;
  if (!options.quick) {
    const Result<Yardsticks> measured = measure_yardsticks(threads);
    if (!measured) return measured.error();
    yardsticks = *measured;
  }
  std::vector<Rows> by_scene;
  for (const AccuracyScene& scene : *scenes) {
    Result<std::vector<ClothPatch>> patches = render_patches(scene, threads);
    if (!patches) return std::move(patches).error();
    const BoundedPatches bounded = with_bounds(std::move(*patches), threads);
    Rows& rows = by_scene.emplace_back();
    for (const Contender& contender : *all) {
      const Result<Json> scored = score(contender, bounded, threads);
      if (!scored) return scored.error();
      rows.push_back({{"scene", scene.name}});
      rows.back().update(*scored);
    }
    compare(rows, *all, yardsticks);
  }
  if (by_scene.size() > 1) by_scene.push_back(means_of(by_scene, *all));
  Rows table;
  for (Rows& rows : by_scene) std::move(rows.begin(), rows.end(), std::back_inserter(table));
  return table;
}

Result<Rows> accuracy_by_leds(const AccuracyTableOptions& options) {
  constexpr int kFewest = 3, kMost = 10;
  const Result<std::vector<AccuracyScene>> scenes = chosen_scenes(options);
  if (!scenes) return scenes.error();
  const Result<std::vector<Contender>> all = contenders_named(options.methods);
  if (!all) return all.error();
  std::vector<std::vector<int>> choices;
  for (int count = kFewest; count <= kMost; ++count) {
    Result<std::vector<int>> choice = leds_by_bound(count);
    if (!choice) return std::move(choice).error();
    choices.push_back(std::move(*choice));
  }
  const int threads = resolved_threads(options.threads);
  std::vector<Rows> rows(choices.size() * all->size());  // a list of scenes for each choice and contender
  for (const AccuracyScene& scene : *scenes) {
    const Result<std::vector<ClothPatch>> patches = render_patches(scene, threads);
    if (!patches) return patches.error();
    for (std::size_t n = 0; n < choices.size(); ++n) {
      std::vector<ClothPatch> fewer;
      for (const ClothPatch& patch : *patches) {
        Result<ClothPatch> chosen = with_lights(patch, choices[n]);
        if (!chosen) return std::move(chosen).error();
        fewer.push_back(std::move(*chosen));
      }
      const BoundedPatches bounded = with_bounds(std::move(fewer), threads);
      for (std::size_t i = 0; i < all->size(); ++i) {
        Result<Json> scored = score((*all)[i], bounded, threads);
        if (!scored) return std::move(scored).error();
        rows[n * all->size() + i].push_back(std::move(*scored));
      }
    }
  }
  Rows table;
  for (std::size_t n = 0; n < choices.size(); ++n) {
    for (std::size_t i = 0; i < all->size(); ++i) {
      std::vector<const Json*> scored;
      for (const Json& row : rows[n * all->size() + i]) scored.push_back(&row);
      table.push_back({{"leds", choices[n].size()}, {"numbers", Json(choices[n]).dump()}});
      table.back().update(mean_row(scored));
    }
  }
  return table;
}

namespace {

SolvePatch by_reference(const solve::ReferenceOptions& options) {
  return by_stages(solve::stages_of(solver::method_of(solver::Level::kReference), options));
}

// By the level reference, whatever gates and left-out light say.
SolvePatch by_forced_reference() {
  std::vector<solve::Stage> stages = solve::stages_of(solver::method_of(solver::Level::kReference));
  for (const char* judge : {"gates", "choice", "comparison"})
    stages = solve::without(judge, std::move(stages));
  return by_stages(std::move(stages));
}

struct Setting {
  const char* curve;
  Contender contender;  ///< named by its setting
};

std::vector<Setting> settings() {
  std::vector<Setting> all = {
      {"resolution", {"half", by_level(solver::method_of(solver::Level::kPreview))}},
      {"resolution", {"full", by_level(solver::method_of(solver::Level::kFast))}},
      {"arithmetic", {"float32", as_product(solver::robust_method())}},
      {"arithmetic", {"double", as_product(solver::exact_method())}},
  };
  for (const int directions : {4, 8, 16, 32, 64}) {
    all.push_back({"directions", {fmt::format("{}", directions), by_reference({.directions = directions})}});
  }
  for (const int rounds : {1, 2, 3, 4, 6}) {
    all.push_back(
        {"rounds", {fmt::format("{}", rounds), by_reference({.most_rounds = rounds, .settled_deg = 0})}});
  }
  return all;
}

}  // namespace

/// What else trades accuracy for time, each as a curve over all scenes: resolution (preview, fast), float or
/// double (robust in float32 kernels and in double), rays a pixel and rounds of the reference level. Rows:
/// "curve", "setting", "mean_deg", "p95_deg", "albedo_mean_rel", "ns_per_pixel", "threads".
Result<Rows> accuracy_curves(const AccuracyTableOptions& options) {
  const std::vector<Setting> all = settings();
  const int threads = resolved_threads(options.threads);
  std::vector<Rows> scored(all.size());
  for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, options.quick)) {
    Result<std::vector<ClothPatch>> patches = render_patches(scene, threads);
    if (!patches) return std::move(patches).error();
    const BoundedPatches bounded = with_bounds(std::move(*patches), threads);
    for (std::size_t i = 0; i < all.size(); ++i) {
      Result<Json> row = score(all[i].contender, bounded, threads);
      if (!row) return std::move(row).error();
      scored[i].push_back(std::move(*row));
    }
  }
  Rows table;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<const Json*> rows;
    for (const Json& row : scored[i]) rows.push_back(&row);
    const Json mean = mean_row(rows);
    table.push_back({{"curve", all[i].curve}, {"setting", all[i].contender.name}});
    for (const char* key : {"mean_deg", "p95_deg", "albedo_mean_rel", "ns_per_pixel", "threads"}) {
      table.back()[key] = mean[key];
    }
  }
  return table;
}

/// What the gates of the reference level decide, by scene: mean error with each gate's say, and with all
/// stages forced. Rows: "scene", "method" (gated, forced), "mean_deg", "p95_deg", "albedo_mean_rel",
/// "ns_per_pixel".
Result<Rows> accuracy_gates(const AccuracyTableOptions& options) {
  const std::vector<Contender> both = {{"gated", by_reference({})}, {"forced", by_forced_reference()}};
  const int threads = resolved_threads(options.threads);
  Rows table;
  for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, options.quick)) {
    Result<std::vector<ClothPatch>> patches = render_patches(scene, threads);
    if (!patches) return std::move(patches).error();
    const BoundedPatches bounded = with_bounds(std::move(*patches), threads);
    for (const Contender& contender : both) {
      const Result<Json> row = score(contender, bounded, threads);
      if (!row) return row.error();
      table.push_back({{"scene", scene.name}, {"method", contender.name}});
      for (const char* key : {"mean_deg", "p95_deg", "albedo_mean_rel", "ns_per_pixel"}) {
        table.back()[key] = (*row)[key];
      }
    }
  }
  return table;
}

namespace {

constexpr double kAlbedo = 0.5, kTilt_deg = 20;
constexpr int kSides = 12;

std::vector<Vec3> test_normals() {
  std::vector<Vec3> normals = {{0, 0, 1}};
  for (int i = 0; i < kSides; ++i) {
    const double azimuth = 2 * kPi * i / kSides, tilt = radians(kTilt_deg);
    normals.push_back(
        {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)});
  }
  return normals;
}

// Sum over the normals of the square of the bound.
double badness(std::span<const LightField::Light> lights, const std::vector<Vec3>& normals,
               const NoiseModel& noise) {
  double sum = 0;
  for (const Vec3 normal : normals) {
    std::vector<LightField::Light> facing;
    for (const LightField::Light& light : lights) {
      if (dot(light.direction, normal) > 0) facing.push_back(light);
    }
    sum += std::pow(cramer_rao(facing, normal, kAlbedo, noise).rms_deg(), 2);
  }
  return sum;
}

}  // namespace

Result<std::vector<int>> leds_by_bound(int count) {
  const simulator::Scene scene;
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();
  const double full = rig->exposure(scene.camera.iso) * rig->sensor.electrons_at_white;
  const NoiseModel noise = {1 / full, std::pow(rig->sensor.read_noise_electrons / full, 2), 0};
  std::vector<LightField::Light> lights;
  for (const DistantLight& light : simulator::distant_lights(*rig, 0).lights) {
    lights.push_back({light.direction, light.irradiance_rgb[1]});
  }
  const std::vector<Vec3> normals = test_normals();
  std::vector<int> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t mask = 0; mask < 1U << lights.size(); ++mask) {
    std::vector<int> numbers;
    std::vector<LightField::Light> chosen;
    for (std::size_t k = 0; k < lights.size(); ++k) {
      if ((mask >> k & 1U) == 0) continue;
      numbers.push_back(static_cast<int>(k) + 1);
      chosen.push_back(lights[k]);
    }
    if (static_cast<int>(numbers.size()) != count) continue;
    if (const double sum = badness(chosen, normals, noise); sum < least) {
      least = sum;
      best = numbers;
    }
  }
  return best;
}

namespace {

constexpr double kWarnFrom = 0.2;
constexpr std::uint32_t kDarkSatinSeeds = 10, kOtherSeeds = 6;

struct Share {
  double share = 0;
  std::string scene;
};

double specular_share(const ClothPatch& patch, const SolvedMaps& maps) {
  const Rect part = patch.measured();
  double specular = 0;
  for (int y = part.y0; y < part.y1; ++y) {
    for (int x = part.x0; x < part.x1; ++x) specular += (maps.status(x, y) & kSpecular) != 0 ? 1 : 0;
  }
  return specular / static_cast<double>(part.pixels());
}

Json row_of(const std::string& method, const char* cloths, std::vector<Share> shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return a.share < b.share; });
  const auto warned =
      std::count_if(shares.begin(), shares.end(), [](const Share& share) { return share.share > kWarnFrom; });
  return {{"method", method},
          {"cloths", cloths},
          {"scenes", shares.size()},
          {"warned", warned},
          {"least", shares.front().share},
          {"median", shares[shares.size() / 2].share},
          {"largest", shares.back().share},
          {"largest_on", shares.back().scene}};
}

}  // namespace

Result<Rows> specular_warnings(const AccuracyTableOptions& options) {
  Result<std::vector<Contender>> all = contenders_named(options.methods);
  if (!all) return std::move(all).error();
  std::erase_if(*all, [](const Contender& contender) { return contender.is_yardstick; });
  const int threads = resolved_threads(options.threads);
  std::vector<std::vector<Share>> dark(all->size()), other(all->size());
  for (std::uint32_t seed = 1; seed <= kDarkSatinSeeds; ++seed) {
    for (const AccuracyScene& scene : accuracy_scenes(options.set, seed, true)) {
      const bool is_dark = scene.material == "dark-satin";
      if (!is_dark && seed > kOtherSeeds) continue;
      const Result<ClothPatch> patch = render_patch(scene.scene, scene.patches.front(), threads);
      if (!patch) return patch.error();
      for (std::size_t i = 0; i < all->size(); ++i) {
        SolvedMaps maps(patch->size());
        if (Result<void> ok = (*all)[i].solve(*patch, threads, maps); !ok) return std::move(ok).error();
        (is_dark ? dark : other)[i].push_back({specular_share(*patch, maps), scene.name});
      }
    }
  }
  Rows rows;
  for (std::size_t i = 0; i < all->size(); ++i) {
    rows.push_back(row_of((*all)[i].name, "dark satin", dark[i]));
    rows.push_back(row_of((*all)[i].name, "other", other[i]));
  }
  return rows;
}

namespace {

// A weave and a material each.
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

Result<ClothPatch> frame_of_cloth(const std::string& name, Size size, int threads) {
  AccuracyTableOptions chosen;
  chosen.scene = name;
  const Result<std::vector<AccuracyScene>> cloth = chosen_scenes(chosen);
  if (!cloth) return cloth.error();
  simulator::Scene scene = cloth->front().scene;
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  return render_patch(scene, {0, 0, size.width, size.height}, threads);
}

Json said_of(const solve::FrameFacts& facts) {
  Json row = Json::object();
  if (facts.gloss) {
    const solver::MeasuredLobe& lobe = facts.gloss->lobes.front();
    row["said"] = lobe.is_measured() ? name_of(lobe.lobe.family) : name_of(lobe.refusal);
  }
  if (!facts.reference) return row;
  const solve::LightStages& stages = facts.reference->stages;
  row["stages"] = std::string(stages.shadows ? "shadows " : "") + (stages.interreflection ? "bounces" : "");
  row["rounds"] = facts.reference->rounds.size();
  return row;
}

}  // namespace

/// What levels take on whole frames in memory, of held-out cloths (bench/accuracy/accuracy_scenes.h).
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
    const Result<ClothPatch> frame = frame_of_cloth(cloth, size, threads);
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
