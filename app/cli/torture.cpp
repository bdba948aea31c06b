// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/carried_scenes.h"
#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "core/base/job_context.h"
#include "core/base/temporary_folder.h"
#include "material/run/maps.h"
#include "simulator/scene/scene.h"
#include "simulator/simulate.h"
#include "simulator/torture_request.h"
#include "solve/run/solve_session.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

Result<void> simulate(const char* text, const fs::path& session, const JobContext& context) {
  const TemporaryFolder scratch;
  const fs::path file = scratch.path() / "scene.toml";
  if (Result<void> ok = write_file(file, text); !ok) return ok;
  const Result<simulator::Scene> scene = simulator::read_scene(file);
  if (!scene) return scene.error();
  simulator::SimulateOptions options;
  options.tiles.threads = context.threads;
  options.stop = context.stop;
  options.progress = [&](int done, int rows) { context.progress("photograph", double(done) / rows); };
  const Result<simulator::SimulationReport> made = simulator::simulate_session(*scene, session, options);
  if (!made) return made.error();
  return {};
}

Result<solve::SolveReport> simulate_and_solve(const char* scene, const fs::path& session,
                                              const solve::SolveOptions& options, const JobContext& context) {
  if (!is_there(session / "session.json")) {
    if (Result<void> ok = simulate(scene, session, context); !ok) return std::move(ok).error();
  }
  return solve::solve_session({session, {}, {}}, options, context);
}

int told(const Json& result, const fs::path& folder, const CommonArguments& common) {
  if (common.json) {
    print_json(result);
  } else {
    print(folder.string());
  }
  return kDone;
}

// Neither makes again what is there already.
Result<int> torture(const fs::path& session, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  solve::SolveOptions options;
  options.condition = true;
  const Result<solve::SolveReport> solved = simulate_and_solve(
      torture_scene(), session, options, {common.threads, stop_on_signal(), line.callback()});
  if (!solved) return solved.error();
  return told({{"session", session.stem().string()}, {"id", solved->facts.id}}, solved->folder, common);
}

Result<int> sample(const fs::path& session, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  const JobContext context = {common.threads, stop_on_signal(), line.callback()};
  const Result<solve::SolveReport> solved = simulate_and_solve(sample_scene(), session, {}, context);
  if (!solved) return solved.error();
  material::MapsOptions options;
  options.session = session;
  const Result<material::MapsReport> maps = material::make_maps(options, context);
  if (!maps) return maps.error();
  const fs::path& folder = maps->folder;
  return told(
      {{"session", session.stem().string()}, {"id", solved->facts.id}, {"maps", folder.filename().string()}},
      folder, common);
}

Run add_torture(Options& options) {
  const auto a = std::make_shared<simulator::TortureRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return torture(a->session, common); };
}

Run add_sample(Options& options) {
  const auto a = std::make_shared<simulator::SampleRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return sample(a->session, common); };
}

}  // namespace

Verb torture_verb() {
  return {"torture", "Simulate pixels that are hard to solve (docs/numerics.md), and solve them",
          add_torture};
}

Verb sample_verb() {
  return {"sample", "Simulate a cloth, solve it and make its maps: something to look at in seconds",
          add_sample};
}

}  // namespace weft::app
