// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulation_plan.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "simulator/build_passes.h"
#include "simulator/effects/bounds.h"
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

/// Seconds of one thread for the frames of all LEDs on `area`.
double seconds_of(const Scene& scene, const SceneRig& rig, Rect area) {
  Result<PassList> passes = build_passes(scene, rig, Output::kCounts);
  if (!passes) return 0;
  PassRunner runner(std::move(*passes), {.threads = 1});
  std::vector<int> leds(rig.leds.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  const Result<void> ran = runner.run(
      area, leds, {}, [](const PassTile&) {}, [](const PassTile&) {});
  const std::vector<PassCost> costs = runner.costs();
  if (!ran) return 0;
  return std::accumulate(costs.begin(), costs.end(), 0.0,
                         [](double sum, const PassCost& cost) { return sum + cost.seconds; });
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
  constexpr int kProbe = 96;
  Scene with = plan.scene;
  for (const EffectKey& key : effect_keys()) {
    if (effect.name == key.name) with.effects.*key.on = true;
  }
  const Result<SceneRig> rig = rig_of(with);
  if (!rig) return 0;
  const auto [width, height] = plan.rig.camera.size;
  const int side = std::min({kProbe, width, height});
  const int x0 = (width - side) / 2, y0 = (height - side) / 2;
  const Rect centre = {x0, y0, x0 + side, y0 + side};
  const double saved = seconds_of(with, *rig, centre) - seconds_of(plan.scene, plan.rig, centre);
  return std::max(saved, 0.0) * static_cast<double>(plan.rig.camera.size.pixels()) /
         static_cast<double>(centre.pixels());
}

}  // namespace weft::simulator
