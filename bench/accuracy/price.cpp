// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <utility>

#include "app/jobs/explain.h"
#include "app/jobs/pictures.h"
#include "app/jobs/solve.h"
#include "bench/accuracy/scenes.h"
#include "bench/base/rig.h"
#include "core/temporary_folder.h"
#include "simulator/simulate.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

Result<std::vector<AccuracyScene>> priced_scenes(const fs::path& folder) {
  std::vector<AccuracyScene> scenes;
  for (const char* name : {"demo", "satin_sheen"}) {
    Result<simulator::Scene> scene = simulator::read_scene(folder / (std::string(name) + ".toml"));
    if (!scene) return std::move(scene).error();
    scenes.push_back({name, "", "", std::move(*scene), {}});
  }
  for (AccuracyScene& scene : accuracy_scenes(SceneSet::kHeldOut, 1, true)) {
    if (scene.name == "plain lambert" || scene.name == "deep satin") scenes.push_back(std::move(scene));
  }
  return scenes;
}

Result<void> add_rows(AccuracyScene scene, double megapixels, int threads, Rows& rows) {
  const TemporaryFolder scratch;
  const Size size = bench_size(megapixels);
  scene.scene.camera.width = size.width;
  scene.scene.camera.height = size.height;
  const fs::path session = scratch.path() / "cloth.weft";
  const auto simulated = simulator::simulate_session(
      scene.scene, session, {.tiles = {.threads = threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();
  // A session with a truth is held against it while pictures are drawn, which no price knows.
  const fs::path truth = scratch.path() / "truth";
  fs::rename(session / "truth", truth);
  const app::SessionOptions input = {.folder = session, .calibration = {}, .leds = {}};
  const JobContext context = {.threads = threads};
  const Result<app::Ladder> ladder = app::explain_session(input, {}, {}, context);
  if (!ladder) return ladder.error();
  for (const app::LevelPrice& price : ladder->levels) {
    app::SolveOptions options;
    options.method = price.name();
    options.output = scratch.path() / price.name();
    const Result<app::SolveReport> solved = app::solve_session(input, options, context);
    if (!solved) return solved.error();
    const double foretold = price.seconds.total(), taken = solved->seconds.total;
    Json row = {{"scene", scene.name},
                {"megapixels", megapixels},
                {"quality", price.name()},
                {"foretold_s", foretold},
                {"taken_s", taken},
                {"seconds_ratio", foretold / taken},
                {"predicted_deg", price.error.total_deg},
                {"predicted_solved", price.error.solved},
                {"solved", solved->expected.solved}};
    if (solved->facts.size == size) {
      const Result<app::TruthError> error =
          app::error_against(truth / "normal.exr", options.output / "normal.exr");
      if (!error) return error.error();
      row["true_deg"] = error->normal.mean_deg;
      row["ratio"] = price.error.total_deg / error->normal.mean_deg;
    }
    rows.push_back(std::move(row));
    fs::remove_all(options.output);
  }
  return {};
}

}  // namespace

/// What `weft solve --explain` foretells of whole sessions, the demo and shot silk and two cloths of the set
/// held out, against what the solves then give and take: a row for each scene, size and level, with degrees,
/// the share of the cloth that they hold for, and seconds, each foretold and true, and their ratios.
Result<Rows> price_table(const AccuracyTableOptions& options, const std::vector<double>& sizes) {
  const Result<std::vector<AccuracyScene>> scenes = priced_scenes(options.scenes);
  if (!scenes) return scenes.error();
  Rows rows;
  for (const AccuracyScene& scene : *scenes) {
    for (const double megapixels : sizes) {
      if (Result<void> ok = add_rows(scene, megapixels, options.threads, rows); !ok)
        return std::move(ok).error();
    }
  }
  return rows;
}

}  // namespace weft::bench
