// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "core/files.h"
#include "simulator/simulate.h"

namespace weft::app {
namespace {

Json json_of(const simulator::SimulationReport& report) {
  Json passes = Json::array(), left_out = Json::array();
  for (const simulator::PassCost& pass : report.passes) {
    passes.push_back({{"effect", pass.name}, {"does", pass.does}, {"seconds", pass.seconds}});
  }
  for (const simulator::LeftOut& effect : report.left_out) {
    left_out.push_back({{"effect", effect.name}, {"why", effect.why}});
  }
  return {{"passes", std::move(passes)}, {"left_out", std::move(left_out)}};
}

void print_passes(const simulator::SimulationReport& report) {
  double sum = 0;
  for (const simulator::PassCost& pass : report.passes) sum += pass.seconds;
  print("pass             seconds  share  what it does");
  for (const simulator::PassCost& pass : report.passes) {
    print(fmt::format("{:<16} {:7.2f} {:5.1f}%  {}", pass.name, pass.seconds,
                      100 * pass.seconds / std::max(sum, 1e-9), pass.does));
  }
  for (const simulator::LeftOut& effect : report.left_out) {
    print(fmt::format("{:<16}    left out    {}", effect.name, effect.why));
  }
}

}  // namespace

Result<int> run_simulate(const SimulateArguments& arguments, const CommonArguments& common) {
  const Result<simulator::Scene> scene = simulator::read_scene(arguments.scene);
  if (!scene) return scene.error();
  ProgressLine line(common.quiet);
  simulator::SimulateOptions options;
  options.tiles.threads = common.threads;
  options.stop = stop_on_signal();
  options.progress = [&](int done, int parts) { line.update("simulate", static_cast<double>(done) / parts); };
  const Result<simulator::SimulationReport> report =
      simulator::simulate_session(*scene, arguments.output, options);
  if (!report) return report.error();
  const std::string session = std::filesystem::absolute(arguments.output).lexically_normal().string();
  if (common.json) {
    Json document = json_of(*report);
    document["session"] = session;
    document["frames"] = report->frames;
    document["exposure_us"] = report->exposure_us;
    document["seconds"] = {{"render", report->render_seconds}, {"write", report->write_seconds}};
    document["peak_bytes"] = peak_memory_bytes();
    print_json(document);
    return kDone;
  }
  if (arguments.explain) print_passes(*report);
  print(fmt::format("{}: {} frames of {} x {} at {:.0f} us, rendered in {:.1f} s, written in {:.1f} s",
                    session, report->frames, scene->camera.width, scene->camera.height, report->exposure_us,
                    report->render_seconds, report->write_seconds));
  return kDone;
}

}  // namespace weft::app
