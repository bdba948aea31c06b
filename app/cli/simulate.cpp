// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "app/cli/exit_code.h"
#include "app/cli/left_out_effects.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "core/rig/exposure_words.h"
#include "simulator/build_passes.h"
#include "simulator/captures.h"
#include "simulator/effects/bounds.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"
#include "simulator/simulate.h"
#include "simulator/simulation_plan.h"

namespace weft::app {
namespace {

using simulator::LeftOutEffect;
using simulator::PassCost;
using simulator::SimulationPlan;

struct SimulateArguments {
  std::filesystem::path scene;
  std::filesystem::path output;
  std::optional<int> led;  ///< one frame alone: a LED from 1, or 0 for the dark shot
  bool explain = false;
  std::optional<double> to_sigma, within_s;  ///< one of both, in the place of the scene's own tolerance
  bool captures = false;                     ///< what calibrating the scene's rig needs, instead of one scan
  std::vector<std::string> parts;            ///< of the captures; empty: all
};

/// What runs and what does not, known before the run.
struct Explanation {
  SimulationPlan plan;
  simulator::PassList passes;
  std::vector<LeftOutEffect> left_out;
  // Only where bounds decided:
  simulator::EffectBounds bounds;
  std::vector<double> saved_seconds;  ///< of one thread, by left-out effect
};

Result<Explanation> explain(const simulator::Scene& scene) {
  Result<SimulationPlan> plan = simulator::plan_of(scene);
  if (!plan) return plan.error();
  Result<simulator::PassList> passes =
      simulator::build_passes(plan->scene, plan->rig, simulator::Output::kCounts);
  if (!passes) return passes.error();
  Explanation explanation = {std::move(*plan), std::move(*passes), {}, {}, {}};
  explanation.left_out = simulator::bounded_left_out(explanation.plan);
  if (scene.auto_to_sigma) {
    explanation.bounds = simulator::bounds_of(explanation.plan.scene, explanation.plan.rig);
    for (const LeftOutEffect& effect : explanation.left_out) {
      explanation.saved_seconds.push_back(simulator::seconds_saved(explanation.plan, effect));
    }
  }
  return explanation;
}

std::string why(const simulator::Pass& pass, const simulator::EffectBounds& bounds) {
  if (pass.effect.empty()) return "every picture needs it";
  if (bounds.empty()) return "the scene names " + pass.effect;
  const auto keys = simulator::effect_keys();
  const auto key =
      std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return pass.effect == k.name; });
  const double sigma = bounds[static_cast<std::size_t>(key - keys.begin())].sigma;
  return std::isinf(sigma) ? pass.effect + ", without bound"
                           : fmt::format("{}, up to {:.2g} sigma", pass.effect, sigma);
}

void print_plan(const Explanation& explanation) {
  print("pass             why it runs                        what it does");
  for (const simulator::Pass& pass : explanation.passes.passes) {
    print(fmt::format("{:<16} {:<34} {}", pass.name, why(pass, explanation.bounds), pass.does));
  }
  print_left_out(explanation.left_out, explanation.saved_seconds);
}

void print_costs(const std::vector<PassCost>& costs) {
  double sum = 0;
  for (const PassCost& pass : costs) sum += pass.seconds;
  print("\npass             thread-seconds  share");
  for (const PassCost& pass : costs) {
    print(fmt::format("{:<16} {:14.2f} {:5.1f}%", pass.name, pass.seconds,
                      100 * pass.seconds / std::max(sum, 1e-9)));
  }
}

Json json_of(const simulator::SimulationReport& report) {
  Json passes = Json::array(), left_out = Json::array();
  for (const PassCost& pass : report.passes) {
    passes.push_back({{"pass", pass.name},
                      {"effect", pass.effect.empty() ? pass.name : pass.effect},
                      {"does", pass.does},
                      {"seconds", pass.seconds}});
  }
  for (const LeftOutEffect& effect : report.left_out) {
    left_out.push_back({{"effect", effect.name}, {"why", effect.why}, {"bound_sigma", effect.bound_sigma}});
  }
  return {{"passes", std::move(passes)}, {"left_out", std::move(left_out)}};
}

Result<int> run_frame(const simulator::Scene& scene, const SimulateArguments& arguments,
                      const CommonArguments& common, const simulator::SimulateOptions& options) {
  const Result<void> done = simulator::simulate_frame(scene, *arguments.led, arguments.output, options);
  if (!done) return done.error();
  const std::string file = std::filesystem::absolute(arguments.output).lexically_normal().string();
  common.json ? print_json({{"frame", file}, {"led", *arguments.led}}) : print(file);
  return kDone;
}

Result<int> run_captures(const simulator::Scene& scene, const SimulateArguments& arguments,
                         const CommonArguments& common, simulator::SimulateOptions options) {
  simulator::CapturesOptions captures;
  captures.parts = arguments.parts;
  captures.seed = scene.seed;
  captures.simulate = std::move(options);
  const Result<simulator::CapturesReport> report =
      simulator::simulate_captures(scene, arguments.output, captures);
  if (!report) return report.error();
  const std::string folder = std::filesystem::absolute(arguments.output).lexically_normal().string();
  if (common.json) {
    print_json({{"folder", folder},
                {"parts", report->parts},
                {"photographs", report->photographs},
                {"sessions", report->sessions}});
  } else {
    print(fmt::format("{}: {}; {} photographs and {} sessions", folder, fmt::join(report->parts, ", "),
                      report->photographs, report->sessions));
  }
  return kDone;
}

Result<int> run_session(simulator::Scene scene, const SimulateArguments& arguments,
                        const CommonArguments& common, const simulator::SimulateOptions& options) {
  std::optional<simulator::TimelyPlan> chosen;
  if (arguments.within_s) {
    const Result<simulator::TimelyPlan> timely =
        simulator::plan_within(scene, *arguments.within_s, {common.threads, options.stop});
    if (!timely) return timely.error();
    chosen = *timely;
    scene.auto_to_sigma = chosen->to_sigma;
  }
  if (arguments.explain && !common.json) {
    const Result<Explanation> explanation = explain(scene);
    if (!explanation) return explanation.error();
    print_plan(*explanation);
  }
  if (chosen && !common.json) {
    print(fmt::format("effects to {:.3g} sigma, {:.2g} s of rendering foretold", chosen->to_sigma,
                      chosen->seconds));
  }
  const Result<simulator::SimulationReport> report =
      simulator::simulate_session(scene, arguments.output, options);
  if (!report) return report.error();
  const std::string session = std::filesystem::absolute(arguments.output).lexically_normal().string();
  if (common.json) {
    Json document = json_of(*report);
    document["session"] = session;
    document["frames"] = report->frames;
    document["exposure_us"] = report->exposure_us;
    document["seconds"] = {{"render", report->render_seconds}, {"write", report->write_seconds}};
    if (chosen) document["foretold"] = {{"to_sigma", chosen->to_sigma}, {"seconds", chosen->seconds}};
    document["peak_bytes"] = peak_memory_bytes();
    print_json(document);
    return kDone;
  }
  if (arguments.explain) print_costs(report->passes);
  print(fmt::format("{}: {} frames of {} x {} at {}, rendered in {:.1f} s, written in {:.1f} s", session,
                    report->frames, scene.camera.width, scene.camera.height,
                    exposure_words(report->exposure_us), report->render_seconds, report->write_seconds));
  return kDone;
}

Result<int> simulate(const SimulateArguments& arguments, const CommonArguments& common) {
  Result<simulator::Scene> scene = simulator::read_scene(arguments.scene);
  if (!scene) return scene.error();
  if (const char* option = arguments.to_sigma ? "--to" : "--within";
      (arguments.to_sigma || arguments.within_s) && !scene->auto_to_sigma) {
    return Error{ErrorKind::kUsage, "the scene says itself which effects run", option,
                 "it names them, and has no effects = \"auto\"",
                 fmt::format("leave {} away, or let them be \"auto\"", option)};
  }
  if (arguments.to_sigma) scene->auto_to_sigma = arguments.to_sigma;
  ProgressLine line(common.quiet);
  simulator::SimulateOptions options;
  options.tiles.threads = common.threads;
  options.stop = stop_on_signal();
  options.progress = [&](int done, int parts) { line.update("simulate", static_cast<double>(done) / parts); };
  if (arguments.led) return run_frame(*scene, arguments, common, options);
  if (arguments.captures) return run_captures(*scene, arguments, common, options);
  return run_session(*scene, arguments, common, options);
}

Run add_simulate(Options& options) {
  const auto a = std::make_shared<SimulateArguments>();
  options.add("scene", &a->scene, "Scene file; weft schema --page scenes lists its keys and units")
      .required();
  options
      .add("-o,--output", &a->output,
           "Session folder to make, NAME.weft, which must not exist; with --led the DNG file, with "
           "--captures the folder of the parts")
      .required();
  const Option led = options.add("--led", &a->led, "Render one frame alone: of this LED, 0 for the dark shot")
                         .not_negative();
  options
      .add_flag("--explain", &a->explain,
                "List the passes that run and why, the effects left out with what they would change and "
                "cost, and after the run what each pass cost")
      .excludes(led);
  const Option to = options
                        .add("--to", &a->to_sigma,
                             "How far off a scene of effects = \"auto\" may be, in standard deviations of "
                             "its noise: effects "
                             "whose bounds together stay below are left out; default the scene's")
                        .in_range(simulator::kAutomaticRange.least, simulator::kAutomaticRange.most);
  const Option within =
      options
          .add("--within", &a->within_s,
               "Seconds that rendering the photographs of a scene of effects = \"auto\" may take: the least "
               "--to that its middle foretells to be so quick")
          .in_range(1e-3, 1e9)
          .excludes(to)
          .excludes(led);
  const Option captures =
      options
          .add("--captures", &a->parts,
               "Take what calibrating this scene's rig needs, a folder a part: all, or some of start, "
               "camera, response, color, lights, check")
          .by_commas()
          .takes(0, 6)
          .excludes(led)
          .excludes(within);
  return [a, captures](const CommonArguments& common) {
    a->captures = captures.is_given();
    std::erase_if(a->parts, [](const std::string& part) { return part.empty() || part == "all"; });
    return simulate(*a, common);
  };
}

}  // namespace

Verb simulate_verb() {
  return {"simulate", "Render a scene (TOML) into a session of raw DNG frames with its truth", add_simulate};
}

}  // namespace weft::app
