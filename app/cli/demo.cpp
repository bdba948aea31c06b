// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/cli/carried_scenes.h"
#include "app/cli/exit_code.h"
#include "app/cli/left_out_effects.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "core/base/process.h"
#include "core/base/temporary_folder.h"
#include "core/describe/field_json.h"
#include "core/rig/session.h"
#include "material/read/compare.h"
#include "simulator/scene/resolution.h"
#include "simulator/simulate.h"
#include "simulator/simulation_plan.h"
#include "solve/run/explain.h"
#include "solve/run/ladder_picture.h"
#include "solve/run/solve_session.h"
#include "virtual_rig/rig_process.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct DemoArguments {
  fs::path output = "demo";
  std::optional<double> megapixels;
  fs::path scene;  ///< empty: the one that the program carries
};

constexpr const char* kVirtualRig = "weft-virtual-rig";

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
  bool is_scanned = false;  ///< else rendered, where no virtual rig is installed
  double scan_seconds = 0;
  std::size_t frames = 0;
  std::vector<solve::LadderStep> levels;  ///< all of them, by their height
  std::string recommended;                ///< the level that the price of this cloth says to buy
  fs::path ladder;                        ///< picture of the same pixels at each level
  solve::NormalComparison normal;
  material::AlbedoComparison albedo;
  std::uint64_t session_bytes = 0, map_bytes = 0;
  std::vector<simulator::LeftOutEffect> left_out;  ///< of the simulation, with what each would change at most

  const solve::LadderStep& bought() const {
    return *std::ranges::find(levels, recommended, &solve::LadderStep::quality);
  }
};

Result<std::unique_ptr<virtual_rig::RigProcess>> started_rig(const DemoArguments& arguments, bool quiet) {
  ProgressLine line(quiet);
  return virtual_rig::RigProcess::start(
      {.programs = program_beside("weft").parent_path(),
       .scene = arguments.scene,
       .folder = arguments.output / "rig",
       .megapixels = arguments.megapixels,
       .rendering = [&line](double share) { line.update("light", share); }});
}

/// `weft scan` on a virtual rig that lasts for it, and the truth beside what it photographed.
Result<void> scan(const DemoArguments& arguments, const simulator::Scene& scene, const fs::path& session,
                  const CommonArguments& common) {
  const auto rig = started_rig(arguments, common.quiet);
  if (!rig) return rig.error();
  std::vector<std::string> command = {"scan",     "-o",         session.string(),
                                      "--fabric", scene.fabric, "--no-preview"};
  if (common.quiet) command.emplace_back("--quiet");
  const auto weft = (*rig)->weft(std::move(command), {});
  if (!weft) return weft.error();
  const std::stop_token stop = stop_on_signal();
  std::optional<int> code;
  while (!(code = (*weft)->wait(1))) {
    if (stop.stop_requested()) return interrupted();
  }
  if (*code != kDone) {
    return Error{ErrorKind::kTryAgain, "the scan has failed", session.string(),
                 fmt::format("exit code {}", *code), "read what it said above"};
  }
  simulator::SimulateOptions options;
  options.tiles.threads = common.threads;
  options.stop = stop;
  return simulator::simulate_truth(scene, session, options);
}

/// The session with its truth straight from the simulator.
Result<void> render(const simulator::Scene& scene, const fs::path& session, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  simulator::SimulateOptions options;
  options.tiles.threads = common.threads;
  options.stop = stop_on_signal();
  options.progress = [&line](int done, int rows) { line.update("render", double(done) / rows); };
  const Result<simulator::SimulationReport> made = simulator::simulate_session(scene, session, options);
  if (!made) return made.error();
  return {};
}

Result<void> photograph(const DemoArguments& arguments, const simulator::Scene& scene,
                        const fs::path& session, const CommonArguments& common) {
  if (is_there(program_beside(kVirtualRig))) return scan(arguments, scene, session, common);
  note("weft: no virtual rig is installed, so the photographs are rendered");
  return render(scene, session, common);
}

// Each level as it is foretold, then as it comes.
Result<void> climb(const fs::path& session, Outcome& outcome, const JobContext& context) {
  const Result<solve::Ladder> ladder = solve::explain_session({session, {}, {}}, {}, {}, context);
  if (!ladder) return ladder.error();
  const Result<std::size_t> chosen = solve::choose_level(*ladder, {});
  if (!chosen) return chosen.error();
  outcome.recommended = ladder->levels[*chosen].name();
  outcome.ladder = session.parent_path() / "ladder.png";
  Result<std::vector<solve::LadderStep>> levels =
      solve::draw_ladder({session, {}, {}}, {}, outcome.ladder, context, ladder->levels);
  if (!levels) return std::move(levels).error();
  outcome.levels = std::move(*levels);
  return {};
}

Result<Outcome> scan_and_solve(const DemoArguments& arguments, const simulator::Scene& scene,
                               const fs::path& session, const CommonArguments& common) {
  Outcome outcome;
  const Result<simulator::SimulationPlan> plan = simulator::plan_of(scene);
  if (!plan) return plan.error();
  outcome.left_out = simulator::bounded_left_out(*plan);
  Stopwatch watch;
  outcome.is_scanned = is_there(program_beside(kVirtualRig));
  if (Result<void> ok = photograph(arguments, scene, session, common); !ok) return std::move(ok).error();
  outcome.scan_seconds = watch.lap();
  const Result<Session> scanned = read_session(session);
  if (!scanned) return scanned.error();
  outcome.frames = scanned->shots.size();
  const Result<std::uint64_t> session_bytes = bytes_in(session / "raw");
  if (!session_bytes) return session_bytes.error();
  outcome.session_bytes = *session_bytes;

  ProgressLine line(common.quiet);
  const JobContext context = {common.threads, stop_on_signal(), line.callback()};
  if (Result<void> ok = climb(session, outcome, context); !ok) return std::move(ok).error();
  const fs::path& maps = outcome.bought().folder;
  const Result<std::uint64_t> map_bytes = bytes_in(maps);
  if (!map_bytes) return map_bytes.error();
  outcome.map_bytes = *map_bytes;
  const auto normal = material::compare_normals(maps / "normal.exr", session / "truth" / "normal.exr", {});
  if (!normal) return normal.error();
  outcome.normal = *normal;
  const auto albedo = material::compare_albedo(maps / "albedo.exr", session / "truth" / "albedo.exr", {});
  if (!albedo) return albedo.error();
  outcome.albedo = *albedo;
  return outcome;
}

// What accuracy costs: foretold from a cut of the frame, and as it came.
void print_levels(const Outcome& o) {
  print("  level          degrees             seconds");
  print("              foretold    true    foretold   taken");
  for (const solve::LadderStep& step : o.levels) {
    if (!step.foretold || !step.taken) continue;
    print(fmt::format("  {:<10}  {:>8.3g} {:>7} {:>11.3g} {:>7.3g}{}", step.quality, step.foretold->mean_deg,
                      step.whole_deg ? fmt::format("{:.3g}", *step.whole_deg) : "-", step.foretold->seconds,
                      step.taken->seconds, step.quality == o.recommended ? "  <- the one to buy" : ""));
  }
}

void print_table(const simulator::Scene& scene, const Outcome& o) {
  const solve::LadderStep& bought = o.bought();
  print(fmt::format("{}, {} x {} pixels, {} frames", scene.fabric, scene.camera.width, scene.camera.height,
                    o.frames));
  print_left_out(o.left_out);
  print("");
  print_levels(o);
  print(fmt::format("  at {}:", bought.quality));
  print(fmt::format("  normal error    mean {:.3f}, median {:.3f}, 95 % under {:.3f} degrees",
                    o.normal.mean_deg, o.normal.median_deg, o.normal.p95_deg));
  print(fmt::format("  albedo error    mean {:.2f} %, bias {:+.2f} %", 100 * o.albedo.mean_rel,
                    100 * o.albedo.bias_rel));
  print(fmt::format("  {}          {:.2f} s{}; {} MB of raw frames, {} MB of maps",
                    o.is_scanned ? "scan  " : "render", o.scan_seconds,
                    o.is_scanned ? " with the virtual rig's start" : "", o.session_bytes / 1000000,
                    o.map_bytes / 1000000));
  print(fmt::format("  look at         {}", fs::absolute(o.ladder).lexically_normal().string()));
  print(fmt::format("                  {}", (bought.folder / "sheet.png").string()));
}

Json outcome_json(const Outcome& o) {
  const solve::LadderStep& bought = o.bought();
  Json seconds = bought.taken ? bought.taken->parts_s : Json::object();
  seconds["scan"] = o.scan_seconds;
  seconds["total"] = bought.taken ? bought.taken->seconds : 0;
  Json levels = Json::array();
  for (const solve::LadderStep& step : o.levels) {
    levels.push_back({{"quality", step.quality},
                      {"folder", step.folder.string()},
                      {"true_deg", step.whole_deg ? Json(*step.whole_deg) : Json()},
                      {"foretold", step.foretold ? object_of(*step.foretold) : Json()},
                      {"taken", step.taken ? object_of(*step.taken) : Json()}});
  }
  Json left_out = Json::array();
  for (const simulator::LeftOutEffect& effect : o.left_out) {
    const bool is_bounded = std::isfinite(effect.bound_sigma);
    left_out.push_back({{"effect", effect.name},
                        {"why", effect.why},
                        {"bound_sigma", is_bounded ? Json(effect.bound_sigma) : Json()}});
  }
  return {
      {"levels", std::move(levels)},
      {"recommended", o.recommended},
      {"ladder", fs::absolute(o.ladder).lexically_normal().string()},
      {"scanned", o.is_scanned},
      {"folder", bought.folder.string()},
      {"sheet", (bought.folder / "sheet.png").string()},
      {"normal",
       {{"mean_deg", o.normal.mean_deg}, {"median_deg", o.normal.median_deg}, {"p95_deg", o.normal.p95_deg}}},
      {"albedo", {{"mean_rel", o.albedo.mean_rel}, {"bias_rel", o.albedo.bias_rel}}},
      {"seconds", std::move(seconds)},
      {"left_out", std::move(left_out)},
      {"session_bytes", o.session_bytes},
      {"map_bytes", o.map_bytes}};
}

Result<int> demo(DemoArguments arguments, const CommonArguments& common) {
  const TemporaryFolder scratch;
  if (arguments.scene.empty()) {
    arguments.scene = scratch.path() / "demo.toml";
    if (Result<void> ok = write_file(arguments.scene, demo_scene()); !ok) return std::move(ok).error();
  }
  Result<simulator::Scene> scene = simulator::read_scene(arguments.scene);
  if (!scene) return std::move(scene).error();
  if (arguments.megapixels) simulator::resize(scene->camera, *arguments.megapixels);
  // A demo is made again each time it is asked for; it removes only what an earlier one left under this name.
  const fs::path session = arguments.output / (arguments.scene.stem().string() + ".weft");
  std::error_code failed;
  if (is_there(session / "truth" / "scene.toml")) fs::remove_all(session, failed);
  if (failed) return cannot_write(session, failed.value());
  if (Result<void> made = make_writable_folder(arguments.output); !made) return std::move(made).error();
  const Result<Outcome> outcome = scan_and_solve(arguments, *scene, session, common);
  if (!outcome) return outcome.error();
  if (common.json) {
    print_json(outcome_json(*outcome));
  } else {
    print_table(*scene, *outcome);
  }
  return kDone;
}

Run add_demo(Options& options) {
  const auto a = std::make_shared<DemoArguments>();
  options.add("scene", &a->scene, "Scene file (TOML); default shot silk");
  options.add("-o,--output", &a->output, "Folder for the session and its maps").shows_default();
  options.add("--megapixels", &a->megapixels, "Size instead of the scene's, millions of pixels")
      .in_range(0.01, 200.0);
  return [a](const CommonArguments& common) { return demo(*a, common); };
}

}  // namespace

Verb demo_verb() {
  return {"demo", "Scan a simulated cloth, and show what each level of accuracy costs on it", add_demo};
}

}  // namespace weft::app
