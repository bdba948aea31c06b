// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/carried_scenes.h"
#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "core/base/job_context.h"
#include "core/base/temporary_folder.h"
#include "core/describe/field_json.h"
#include "material/run/derived_maps.h"
#include "material/run/maps.h"
#include "simulator/sample_request.h"
#include "simulator/scene/scene.h"
#include "simulator/simulate.h"
#include "solve/run/solve_session.h"
#include "torture/hard_case.h"
#include "torture/torture_request.h"

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

// Neither makes again what is there already.
Result<solve::SolveReport> simulate_and_solve(const char* scene, const fs::path& session,
                                              const solve::SolveOptions& options, const JobContext& context) {
  if (!is_there(session / "session.json")) {
    if (Result<void> ok = simulate(scene, session, context); !ok) return std::move(ok).error();
  }
  return solve::solve_session({session, {}, {}}, options, context);
}

std::string number_of(const std::optional<double>& error, const char* none) {
  if (!error) return none;
  return fmt::format("{:.{}g}", *error, *error < 1000 && *error >= 100 ? 3 : 2);
}

void print_cases(const std::vector<torture::HardCase>& cases) {
  std::size_t width = 0;
  for (const torture::HardCase& hard : cases) width = std::max(width, hard.what.size());
  print(
      fmt::format("{:<{}}  {:>13}  {:>7}  off, and what weft says", "", width + 2, "plain formula", "weft"));
  std::string stage;
  for (const torture::HardCase& hard : cases) {
    if (hard.stage != stage) print(hard.stage);
    stage = hard.stage;
    print(fmt::format("  {:<{}}  {:>13}  {:>7}  {}{}{}{}", hard.what, width,
                      number_of(hard.plain, "no number"), number_of(hard.ours, "-"), hard.unit,
                      hard.flag.empty() ? "" : "; ", hard.flag,
                      hard.holds() ? "" : fmt::format("; OFF ITS BOUND of {:.2g}", hard.within)));
  }
}

Result<int> torture(const torture::TortureRequest& request, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  solve::SolveOptions options;
  options.condition = true;
  const Result<solve::SolveReport> solved = simulate_and_solve(
      torture_scene(), request.session, options, {common.threads, stop_on_signal(), line.callback()});
  if (!solved) return solved.error();
  const std::vector<torture::HardCase> cases = torture::hard_cases();
  const auto off = std::ranges::count_if(cases, [](const auto& hard) { return !hard.holds(); });
  if (common.json) {
    print_json({{"session", request.session.stem().string()},
                {"id", solved->facts.id},
                {"cases", list_of(cases)},
                {"off", off}});
  } else {
    print_cases(cases);
    print(fmt::format("{} hard cases, {} off their bounds", cases.size(), off));
    print(fmt::format("hard pixels in one picture: {}", (solved->folder / "status.png").string()));
  }
  return request.is_strict && off > 0 ? kDoneWithWarnings : kDone;
}

Result<int> sample(const fs::path& session, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  const JobContext context = {common.threads, stop_on_signal(), line.callback()};
  const Result<solve::SolveReport> solved = simulate_and_solve(sample_scene(), session, {}, context);
  if (!solved) return solved.error();
  material::MapsOptions options;
  options.session = session;
  for (const material::DerivedMap& map : material::derived_maps()) options.maps.emplace_back(map.name);
  const Result<material::MapsReport> maps = material::make_maps(options, context);
  if (!maps) return maps.error();
  const fs::path& folder = maps->folder;
  if (common.json) {
    print_json({{"session", session.stem().string()},
                {"id", solved->facts.id},
                {"maps", folder.filename().string()}});
  } else {
    print(folder.string());
  }
  return kDone;
}

Run add_torture(Options& options) {
  const auto a = std::make_shared<torture::TortureRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return torture(*a, common); };
}

Run add_sample(Options& options) {
  const auto a = std::make_shared<simulator::SampleRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return sample(a->session, common); };
}

}  // namespace

Verb torture_verb() {
  return {
      "torture",
      "Hard cases of every stage: how far off a plain formula is and weft, in degrees, pixels or percent, "
      "and a scene of hard pixels",
      add_torture};
}

Verb sample_verb() {
  return {"sample", "Simulate a cloth, solve it and make its maps: something to look at in seconds",
          add_sample};
}

}  // namespace weft::app
