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
#include "core/base/temporary_folder.h"
#include "simulator/scene/scene.h"
#include "simulator/simulate.h"
#include "simulator/torture_request.h"
#include "solve/run/solve_session.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

Result<void> simulate(const fs::path& session, int threads, const std::stop_token& stop) {
  const TemporaryFolder scratch;
  const fs::path file = scratch.path() / "torture.toml";
  if (Result<void> ok = write_file(file, torture_scene()); !ok) return ok;
  const Result<simulator::Scene> scene = simulator::read_scene(file);
  if (!scene) return scene.error();
  simulator::SimulateOptions options;
  options.tiles.threads = threads;
  options.stop = stop;
  const Result<simulator::SimulationReport> made = simulator::simulate_session(*scene, session, options);
  if (!made) return made.error();
  return {};
}

/// A session and a solve that are there already are not made again.
Result<int> torture(const fs::path& session, const CommonArguments& common) {
  const std::stop_token stop = stop_on_signal();
  if (!is_there(session / "session.json")) {
    if (Result<void> ok = simulate(session, common.threads, stop); !ok) return std::move(ok).error();
  }
  ProgressLine line(common.quiet);
  solve::SolveOptions options;
  options.condition = true;
  const Result<solve::SolveReport> solved =
      solve::solve_session({session, {}, {}}, options, {common.threads, stop, line.callback()});
  if (!solved) return solved.error();
  if (common.json) {
    print_json({{"session", session.stem().string()}, {"id", solved->facts.id}});
  } else {
    print(solved->folder.string());
  }
  return kDone;
}

Run add_torture(Options& options) {
  const auto a = std::make_shared<simulator::TortureRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return torture(a->session, common); };
}

}  // namespace

Verb torture_verb() {
  return {"torture", "Simulate pixels that are hard to solve (docs/numerics.md), and solve them",
          add_torture};
}

}  // namespace weft::app
