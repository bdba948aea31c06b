// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/effects_studies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bench/base/measured_rig.h"
#include "bench/effects/effect_scenes.h"
#include "core/base/parallel.h"
#include "simulator/build_passes.h"
#include "simulator/simulation_plan.h"

namespace weft::bench {
namespace {

using namespace simulator;

constexpr double kMostTraced = 1;          // megapixels
constexpr double kMostTracedAFrame = 0.1;  // where every frame is traced anew, as the cloth moves
constexpr int kRounds = 3;
constexpr double kLong_s = 3;  // what took longer is not run again

bool is_traced(const EffectSettings& effects) {
  return effects.cast_shadows || effects.interreflection;
}

struct Measured {
  std::string name;
  EffectSettings effects, without;
  double megapixels = 0;
  double ns_per_pixel = std::numeric_limits<double>::infinity();
  double seconds = 0;  ///< of the last run
};

std::vector<Measured> everything(double megapixels) {
  std::vector<Measured> all = {{"lambert", {}, {}}};
  for (const EffectKey& key : effect_keys()) {
    all.push_back({key.name, effects_for(key.on), effects_under(key.on)});
  }
  EffectSettings soft = effects_for(&EffectSettings::cast_shadows);
  soft.finite_led = true;
  all.push_back({"cast_shadows + finite_led", soft, effects_under(&EffectSettings::cast_shadows)});
  EffectSettings noisy = effects_for(&EffectSettings::near_light);
  noisy.noise = true;
  all.push_back({"near_light + noise", noisy, {}});
  EffectSettings still = all_effects();
  still.movement = false;
  all.push_back({"all but movement", still, {}});
  all.push_back({"all", all_effects(), {}});
  for (Measured& m : all) {
    m.megapixels = megapixels;
    if (is_traced(m.effects)) {
      m.megapixels = std::min(megapixels, m.effects.movement ? kMostTracedAFrame : kMostTraced);
    }
  }
  return all;
}

Result<void> run(Measured& m, int threads) {
  Scene scene = cloth_scene(Family::kPlain, bench_size(m.megapixels));
  scene.effects = m.effects;
  const Result<SceneRig> rig = rig_of(scene);
  if (!rig) return rig.error();
  Result<PassList> passes = build_passes(scene, *rig, Output::kCounts);
  if (!passes) return passes.error();
  PassRunner runner(std::move(*passes), {.threads = threads});
  std::vector<int> leds(rig->leds.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  const Rect frame = {0, 0, scene.camera.width, scene.camera.height};
  Result<void> ran;
  m.seconds = least_seconds(1, [&] {
    ran = runner.run(
        frame, leds, {}, [](const PassTile&) {}, [](const PassTile&) {});
  });
  const double samples = static_cast<double>(frame.pixels()) * static_cast<double>(leds.size());
  m.ns_per_pixel = std::min(m.ns_per_pixel, m.seconds * 1e9 / samples);
  return ran;
}

}  // namespace

/// What each effect costs: frames of cloth_scene() under ten LEDs, from the scene to counts in memory. All
/// figures are wall time over pixels and frames, so what LEDs share (surface, mesh, bounces) is spread over
/// ten as in a session; the least of three rounds. Rows are the plain Lambert frame, each effect with only
/// what it requires, near light with noise, soft shadows, and all together:
///   ns_per_pixel  of a frame
///   added_ns      over the same scene without the effect
///   ratio         over the plain Lambert frame
///   s_16mp        seconds for a frame of 16 megapixels at that rate
/// Scenes that trace rays are measured on 1 megapixel at most, those that trace every frame anew because the
/// cloth moves on 0.1, and what takes over 3 seconds only once.
Result<Rows> effects_cost(const StudyOptions& options) {
  std::vector<Measured> all = everything(options.megapixels);
  const int threads = resolved_threads(options.threads);
  // In rounds, so that a minute in which the machine is busy touches every row alike.
  for (int round = 0; round < kRounds; ++round) {
    for (Measured& m : all) {
      if (m.seconds > kLong_s) continue;
      if (Result<void> ok = run(m, threads); !ok) return ok.error();
    }
  }
  Rows rows;
  for (const Measured& m : all) {
    const auto base = std::find_if(all.begin(), all.end(),
                                   [&](const Measured& other) { return other.effects == m.without; });
    rows.push_back({{"effect", m.name},
                    {"megapixels", m.megapixels},
                    {"threads", threads},
                    {"ns_per_pixel", m.ns_per_pixel},
                    {"added_ns", m.ns_per_pixel - base->ns_per_pixel},
                    {"ratio", m.ns_per_pixel / all.front().ns_per_pixel},
                    {"s_16mp", m.ns_per_pixel * 16e-3}});
  }
  return rows;
}

namespace {

constexpr double kToSigma = 0.25;
constexpr double kMegapixels = 0.03;  // all effects trace every frame anew, as the cloth moves

/// What photosites hold before they are counted, 1 is full scale: a plane a LED, then the dark frame.
struct Frames {
  Image<double> samples;
  double seconds = 0;
};

Result<Frames> frames_without_noise(Scene scene, int threads) {
  scene.effects.noise = false;
  const Result<SceneRig> rig = rig_of(scene);
  if (!rig) return rig.error();
  Result<PassList> passes = build_passes(scene, *rig, Output::kCounts);
  if (!passes) return passes.error();
  std::vector<int> leds(rig->leds.leds.size() + 1);
  std::iota(leds.begin(), leds.end(), 0);
  const Size size = rig->camera.size;
  Frames frames = {Image<double>(size, static_cast<int>(leds.size())), 0};
  PassRunner runner(std::move(*passes), {.threads = threads});
  Result<void> ran;
  frames.seconds = least_seconds(1, [&] {
    ran = runner.run(
        {0, 0, size.width, size.height}, leds, {}, [](const PassTile&) {},
        [&](const PassTile& tile) {
          for_each_pixel(tile.rect, [&](std::size_t, int x, int y) {
            frames.samples(x, y, tile.led) =
                std::clamp(tile.samples[index_in(tile.sample_rect, x, y)], 0.0, 1.0);
          });
        });
  });
  if (!ran) return ran.error();
  return frames;
}

/// Differences in sigma of the noise of a photosite.
struct Difference {
  double rms_sigma = 0, largest_sigma = 0;
};

Difference difference(const Image<double>& tested, const Image<double>& truth, const Sensor& sensor) {
  const double e = sensor.electrons_at_white, read = sensor.read_noise_electrons;
  double square = 0, largest = 0;
  for (int k = 0; k < truth.planes(); ++k) {
    for (int y = 0; y < truth.height(); ++y) {
      for (int x = 0; x < truth.width(); ++x) {
        const double sigma = std::sqrt(std::max(tested(x, y, k), truth(x, y, k)) * e + read * read) / e;
        const double off = (tested(x, y, k) - truth(x, y, k)) / sigma;
        square += off * off;
        largest = std::max(largest, std::abs(off));
      }
    }
  }
  const double samples = static_cast<double>(truth.width()) * truth.height() * truth.planes();
  return {std::sqrt(square / samples), largest};
}

Result<Json> row_of(const NamedScene& named, int threads) {
  Scene choosing = named.scene;
  choosing.auto_to_sigma = kToSigma;
  const Result<SimulationPlan> plan = plan_of(choosing);
  if (!plan) return plan.error();
  Scene everything = named.scene;
  everything.effects = all_effects();
  everything.effects.spectral = everything.material.warp_dye.has_value();

  const Result<Frames> chosen = frames_without_noise(plan->scene, threads);
  if (!chosen) return chosen.error();
  const Result<Frames> all = frames_without_noise(everything, threads);
  if (!all) return all.error();

  std::string left_out;
  for (const LeftOutEffect& effect : plan->left_out) left_out += (left_out.empty() ? "" : " ") + effect.name;
  const Difference off = difference(chosen->samples, all->samples, plan->rig.sensor);
  const double frames = static_cast<double>(plan->rig.camera.size.pixels()) * chosen->samples.planes();
  return Json{{"effect", "auto"},
              {"scene", named.name},
              {"megapixels", static_cast<double>(plan->rig.camera.size.pixels()) * 1e-6},
              {"rms_sigma", off.rms_sigma},
              {"largest_sigma", off.largest_sigma},
              {"ns_per_pixel", chosen->seconds * 1e9 / frames},
              {"threads", threads},
              {"ratio", chosen->seconds / all->seconds},
              {"left_out", left_out}};
}

}  // namespace

/// `effects = "auto"` at 0.25 sigma against every effect there is, on a gallery of small scenes: how far the
/// frames of all LEDs and the dark one differ before the converter, noise off on both sides, in sigma of the
/// noise of each photosite, and what share of the time auto takes. `left_out` names what it does without;
/// `ns_per_pixel` is auto's, `ratio` over that of all effects.
Result<Rows> effects_auto(const StudyOptions& options) {
  Rows rows;
  for (const NamedScene& scene : auto_gallery(bench_size(kMegapixels))) {
    if (Result<void> ok = add_row(rows, row_of(scene, resolved_threads(options.threads))); !ok)
      return ok.error();
  }
  return rows;
}

}  // namespace weft::bench
