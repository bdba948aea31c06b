// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "app/jobs/compare.h"
#include "app/jobs/solve.h"
#include "core/files.h"
#include "simulator/simulate.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// The scene at another resolution: the same piece of cloth, more or fewer pixels a millimetre.
void resize(simulator::CameraSettings& camera, double megapixels) {
  const double factor = std::sqrt(megapixels * 1e6 / (static_cast<double>(camera.width) * camera.height));
  const auto even = [&](int side) {
    return std::max(2, 2 * static_cast<int>(std::lround(side * factor / 2)));
  };
  const int width = even(camera.width);
  camera.mm_per_pixel *= static_cast<double>(camera.width) / width;
  camera.height = even(camera.height);
  camera.width = width;
}

Result<std::uint64_t> bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, failed)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  if (failed) return cannot_read(folder, failed.value());
  return bytes;
}

struct Outcome {
  simulator::SimulationReport simulated;
  SolveReport solved;
  NormalComparison normal;
  AlbedoComparison albedo;
  std::uint64_t session_bytes = 0, map_bytes = 0;
};

Result<Outcome> scan_and_solve(const simulator::Scene& scene, const fs::path& session,
                               const CommonArguments& common) {
  ProgressLine line(common.quiet);
  const std::stop_token stop = stop_on_signal();
  Outcome outcome;
  auto simulated = simulator::simulate_session(
      scene, session,
      {.tiles = {.threads = common.threads}, .stop = stop, .progress = [&](int done, int parts) {
         line.update("simulate", static_cast<double>(done) / parts);
       }});
  if (!simulated) return std::move(simulated).error();
  outcome.simulated = std::move(*simulated);
  const Result<std::uint64_t> session_bytes = bytes_in(session / "raw");
  if (!session_bytes) return session_bytes.error();
  outcome.session_bytes = *session_bytes;

  Result<SolveReport> solved = solve_session({session, {}, {}}, {}, {common.threads, stop, line.callback()});
  if (!solved) return std::move(solved).error();
  outcome.solved = std::move(*solved);
  const fs::path& maps = outcome.solved.folder;
  const Result<std::uint64_t> map_bytes = bytes_in(maps);
  if (!map_bytes) return map_bytes.error();
  outcome.map_bytes = *map_bytes;
  const auto normal = compare_normals(maps / "normal.exr", session / "truth" / "normal.exr", {});
  if (!normal) return normal.error();
  outcome.normal = *normal;
  const auto albedo = compare_albedo(maps / "albedo.exr", session / "truth" / "albedo.exr", {});
  if (!albedo) return albedo.error();
  outcome.albedo = *albedo;
  return outcome;
}

void print_table(const simulator::Scene& scene, const Outcome& o) {
  const SolveSeconds& s = o.solved.seconds;
  print(fmt::format("{}, {} x {} pixels, {} frames", scene.fabric, scene.camera.width, scene.camera.height,
                    o.simulated.frames));
  print(fmt::format("  normal error    mean {:.3f}, median {:.3f}, 95 % under {:.3f} degrees",
                    o.normal.mean_deg, o.normal.median_deg, o.normal.p95_deg));
  print(fmt::format("  albedo error    mean {:.2f} %, bias {:+.2f} %", 100 * o.albedo.mean_rel,
                    100 * o.albedo.bias_rel));
  print(fmt::format("  scan            {:.2f} s rendering, {:.2f} s writing, {} MB of raw frames",
                    o.simulated.render_seconds, o.simulated.write_seconds, o.session_bytes / 1000000));
  print(
      fmt::format("  solve           {:.2f} s: read {:.2f}, solve {:.2f}, write {:.2f}, pictures {:.2f}, "
                  "sync {:.2f}; {} MB of maps",
                  s.total, s.read, s.solve, s.write, s.pictures, s.sync, o.map_bytes / 1000000));
  print(fmt::format("  look at         {}", (o.solved.folder / "sheet.png").string()));
}

Json json_of(const Outcome& o) {
  const SolveSeconds& s = o.solved.seconds;
  return {
      {"folder", o.solved.folder.string()},
      {"sheet", (o.solved.folder / "sheet.png").string()},
      {"normal",
       {{"mean_deg", o.normal.mean_deg}, {"median_deg", o.normal.median_deg}, {"p95_deg", o.normal.p95_deg}}},
      {"albedo", {{"mean_rel", o.albedo.mean_rel}, {"bias_rel", o.albedo.bias_rel}}},
      {"seconds",
       {{"simulate", o.simulated.render_seconds + o.simulated.write_seconds},
        {"read", s.read},
        {"solve", s.solve},
        {"write", s.write},
        {"pictures", s.pictures},
        {"sync", s.sync},
        {"total", s.total}}},
      {"session_bytes", o.session_bytes},
      {"map_bytes", o.map_bytes}};
}

}  // namespace

Result<int> run_demo(const DemoArguments& arguments, const CommonArguments& common) {
  Result<simulator::Scene> scene = simulator::read_scene(arguments.scene);
  if (!scene) return std::move(scene).error();
  if (arguments.megapixels) resize(scene->camera, *arguments.megapixels);
  // A demo is made again each time it is asked for; it removes only what an earlier one left under this name.
  const fs::path session = arguments.output / (arguments.scene.stem().string() + ".weft");
  std::error_code failed;
  if (is_there(session / "truth" / "scene.toml")) fs::remove_all(session, failed);
  if (failed) return cannot_write(session, failed.value());
  if (Result<void> made = make_writable_folder(arguments.output); !made) return std::move(made).error();
  const Result<Outcome> outcome = scan_and_solve(*scene, session, common);
  if (!outcome) return outcome.error();
  if (common.json) {
    print_json(json_of(*outcome));
  } else {
    print_table(*scene, *outcome);
  }
  return kDone;
}

}  // namespace weft::app
