// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "bench/accuracy/contenders.h"
#include "bench/accuracy/score.h"
#include "core/parallel.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

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
    Result<std::vector<Patch>> patches = render_patches(scene, threads);
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
  const std::vector<Contender> both = {{"gated", by_reference({})},
                                       {"forced", by_reference({.force_stages = true})}};
  const int threads = resolved_threads(options.threads);
  Rows table;
  for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, options.quick)) {
    Result<std::vector<Patch>> patches = render_patches(scene, threads);
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

}  // namespace weft::bench
