// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/studies.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bench/base/rig.h"
#include "bench/effects/scenes.h"
#include "core/parallel.h"
#include "simulator/build_passes.h"
#include "simulator/plan.h"

namespace weft::bench {
namespace {

using namespace simulator;

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
        {0, 0, size.width, size.height}, leds, {}, [](const Tile&) {},
        [&](const Tile& tile) {
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
  const Result<Plan> plan = plan_of(choosing);
  if (!plan) return plan.error();
  Scene everything = named.scene;
  everything.effects = all_effects();
  everything.effects.spectral = everything.material.warp_dye.has_value();

  const Result<Frames> chosen = frames_without_noise(plan->scene, threads);
  if (!chosen) return chosen.error();
  const Result<Frames> all = frames_without_noise(everything, threads);
  if (!all) return all.error();

  std::string left_out;
  for (const LeftOut& effect : plan->left_out) left_out += (left_out.empty() ? "" : " ") + effect.name;
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
    Result<Json> row = row_of(scene, resolved_threads(options.threads));
    if (!row) return row.error();
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace weft::bench
