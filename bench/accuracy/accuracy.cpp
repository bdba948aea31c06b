// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "bench/accuracy/contenders.h"
#include "bench/accuracy/score.h"
#include "bench/base/yardsticks.h"
#include "core/parallel.h"

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
    Result<std::vector<Patch>> patches = render_patches(scene, threads);
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
    const Result<std::vector<Patch>> patches = render_patches(scene, threads);
    if (!patches) return patches.error();
    for (std::size_t n = 0; n < choices.size(); ++n) {
      std::vector<Patch> fewer;
      for (const Patch& patch : *patches) {
        Result<Patch> chosen = with_lights(patch, choices[n]);
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

}  // namespace weft::bench
