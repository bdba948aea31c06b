// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulation_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "simulator/build_passes.h"
#include "simulator/effects/bounds.h"
#include "simulator/scene/scene_key.h"
#include "simulator/spectra/observer.h"

namespace weft::simulator {
namespace {

/// Whether there is anything to see by wavelength, and filters to see it through.
bool has_spectra(const Scene& scene) {
  const MaterialSettings& m = scene.material;
  const bool has_chart =
      std::any_of(scene.targets.begin(), scene.targets.end(),
                  [](const TargetSettings& target) { return kind_of(target.pattern) == TargetKind::kChart; });
  return (m.dye || (m.warp_dye && m.weft_dye) || has_chart) &&
         camera_weights(scene.spectra.led, scene.spectra.filters).has_value();
}

/// Every effect that the scene has anything for.
EffectSettings all_effects(const Scene& scene) {
  EffectSettings all;
  for (const EffectKey& effect : effect_keys()) all.*effect.on = true;
  all.spectral = has_spectra(scene);
  return all;
}

std::vector<LeftOutEffect> unnamed(const EffectSettings& effects) {
  std::vector<LeftOutEffect> left_out;
  for (const EffectKey& effect : effect_keys()) {
    if (!(effects.*effect.on)) left_out.push_back({effect.name, "the scene does not name it"});
  }
  return left_out;
}

/// Seconds of one thread for the frames of all LEDs, as the centre of the frame foretells.
double seconds_by_centre(const Scene& scene, const SceneRig& rig) {
  constexpr int kProbe = 96;
  Result<PassList> passes = build_passes(scene, rig, Output::kCounts);
  if (!passes) return 0;
  const int band_rows = passes->halo > 0 ? kTallBandRows : kBandRows;
  PassRunner runner(std::move(*passes), {.threads = 1});
  std::vector<int> leds(rig.leds.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  const auto [width, height] = rig.camera.size;
  const int side = std::min({kProbe, width, height});
  const int x0 = (width - side) / 2, y0 = (height - side) / 2;
  const Rect centre = {x0, y0, x0 + side, y0 + side};
  const Result<void> ran = runner.run(
      centre, leds, {}, [](const PassTile&) {}, [](const PassTile&) {});
  const std::vector<PassCost> costs = runner.costs();
  if (!ran) return 0;
  const double seconds = std::accumulate(costs.begin(), costs.end(), 0.0,
                                         [](double sum, const PassCost& cost) { return sum + cost.seconds; });
  const int rows = std::min(band_rows, height);
  const double bands = static_cast<double>(height) / rows;
  return seconds * bands * static_cast<double>(runner.pixels_with_halos({0, 0, width, rows})) /
         static_cast<double>(runner.pixels_with_halos({0, 0, side, side}));
}

/// How often a session lights all LEDs.
int lit_rounds(const Scene& scene) {
  return 1 + (scene.camera.retakes.bracket ? 1 : 0) + (scene.films.states == FilmStates::kBoth ? 1 : 0);
}

}  // namespace

Result<SimulationPlan> plan_of(const Scene& scene) {
  SimulationPlan plan = {scene, {}, {}};
  if (scene.auto_to_sigma) {
    plan.scene.auto_to_sigma.reset();
    plan.scene.effects = all_effects(scene);
    const Result<SceneRig> everything = rig_of(plan.scene);
    if (!everything) return everything.error();
    plan.scene.effects = effects_within(plan.scene, *everything, *scene.auto_to_sigma, plan.left_out);
  } else {
    plan.left_out = unnamed(scene.effects);
  }
  Result<SceneRig> rig = rig_of(plan.scene);
  if (!rig) return rig.error();
  plan.rig = std::move(*rig);
  return plan;
}

std::vector<LeftOutEffect> bounded_left_out(const SimulationPlan& plan) {
  const EffectBounds bounds = bounds_of(plan.scene, plan.rig);
  std::vector<LeftOutEffect> left_out;
  std::size_t i = 0;
  for (const EffectKey& key : effect_keys()) {
    const EffectBound& bound = bounds[i++];
    const bool is_out =
        std::ranges::find(plan.left_out, key.name, &LeftOutEffect::name) != plan.left_out.end();
    if (is_out) left_out.push_back({key.name, bound.why, bound.sigma});
  }
  std::ranges::stable_sort(left_out, {}, &LeftOutEffect::bound_sigma);
  return left_out;
}

double seconds_saved(const SimulationPlan& plan, const LeftOutEffect& effect) {
  Scene with = plan.scene;
  for (const EffectKey& key : effect_keys()) {
    if (effect.name == key.name) with.effects.*key.on = true;
  }
  const Result<SceneRig> rig = rig_of(with);
  if (!rig) return 0;
  return std::max(seconds_by_centre(with, *rig) - seconds_by_centre(plan.scene, plan.rig), 0.0);
}

Result<TimelyPlan> plan_within(const Scene& scene, double within_s, const JobContext& context) {
  constexpr double kCloseEnough = 1.05;
  std::vector<std::pair<EffectSettings, double>> known;
  const auto plan_at = [&](double to_sigma) -> Result<TimelyPlan> {
    if (context.stop.stop_requested()) return interrupted();
    Scene as_asked = scene;
    as_asked.auto_to_sigma = to_sigma;
    const Result<SimulationPlan> plan = plan_of(as_asked);
    if (!plan) return plan.error();
    const auto is_same = [&](const auto& each) { return each.first == plan->scene.effects; };
    auto at = std::ranges::find_if(known, is_same);
    if (at == known.end()) {
      const double seconds = lit_rounds(plan->scene) * seconds_by_centre(plan->scene, plan->rig) /
                             resolved_threads(context.threads);
      at = known.insert(known.end(), {plan->scene.effects, seconds});
    }
    return TimelyPlan{to_sigma, at->second};
  };
  Result<TimelyPlan> strict = plan_at(kAutomaticRange.least);
  if (!strict || strict->seconds <= within_s) return strict;
  Result<TimelyPlan> loose = plan_at(kAutomaticRange.most);
  if (!loose) return loose;
  if (loose->seconds > within_s) {
    return Error{ErrorKind::kUsage, "no scene is that quick", fmt::format("--within {:g} s", within_s),
                 fmt::format("{:.3g} s are foretold with as many effects left out as may be", loose->seconds),
                 "allow more, or let the camera have fewer pixels"};
  }
  while (loose->to_sigma > kCloseEnough * strict->to_sigma) {
    Result<TimelyPlan> between = plan_at(std::sqrt(strict->to_sigma * loose->to_sigma));
    if (!between) return between;
    (between->seconds <= within_s ? loose : strict) = *between;
  }
  return loose;
}

}  // namespace weft::simulator
