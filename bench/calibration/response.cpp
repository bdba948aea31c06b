// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "app/jobs/calibrate/response.h"
#include "calibration/response/superposition.h"
#include "core/files.h"
#include "core/temporary_folder.h"
#include "simulator/scene/rig.h"
#include "simulator/simulate.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array<double, 2> kBend = {0.017, 0.0085};
constexpr std::array<double, 7> kShares = {0.01, 0.03, 0.1, 0.25, 0.45, 0.9, 1.8};  // of the scene's exposure
constexpr int kFramesEach = 2, kDarkFrames = 4;

simulator::Scene scene_of(simulator::Body body, std::int64_t seed) {
  simulator::Scene scene;
  scene.seed = seed;
  scene.camera.body = body;
  scene.camera.width = 768;
  scene.camera.height = 512;
  scene.camera.mm_per_pixel = 0.2;
  scene.camera.linearity = kBend;
  scene.camera.retakes.shutter_error = 0.004;
  scene.camera.defects.dark_electrons_per_s = 5;
  scene.camera.defects.response_percent = 0.4;
  scene.camera.defects.column_counts = 0.3;
  scene.camera.defects.photosite_counts = 0.3;
  scene.lights.drift = 0.003;
  scene.lights.flicker = 0.001;
  scene.material.albedo = {0.4, 0.4, 0.4};
  simulator::TargetSettings paper;
  paper.pattern = simulator::PaperSettings{120, 80};
  paper.centre_mm.z = 1;
  scene.targets = {paper};
  simulator::EffectSettings& e = scene.effects;
  e.near_light = e.noise = e.nonlinearity = e.dark_current = e.uneven_response = e.led_drift = true;
  return scene;
}

Result<void> capture(const simulator::Scene& scene, double scene_exposure_us, const fs::path& folder,
                     int threads) {
  simulator::SimulateOptions options;
  options.tiles.threads = threads;
  int takes = 0;
  const auto take = [&](const std::vector<int>& leds, const std::string& name, double exposure_us,
                        int frames) -> Result<void> {
    if (Result<void> ok = make_writable_folder(folder / name); !ok) return ok;
    for (int i = 0; i < frames; ++i) {
      options.takes_before = takes;
      takes += static_cast<int>(scene.lights.leds.size()) + 11;
      const fs::path file = folder / name / fmt::format("{:09.0f}_{}.dng", exposure_us, i);
      if (Result<void> ok = simulate_photograph(scene, {leds, exposure_us}, file, options); !ok) return ok;
    }
    return {};
  };
  for (const double share : {kShares.front(), kShares.back()}) {
    if (Result<void> ok = take({}, "dark", std::round(share * scene_exposure_us), kDarkFrames); !ok)
      return ok;
  }
  for (const double share : kShares) {
    const double exposure_us = std::round(share * scene_exposure_us);
    for (const auto& [leds, name] :
         {std::pair<std::vector<int>, std::string>{{1}, "led01"}, {{2}, "led02"}, {{1, 2}, "led01+led02"}}) {
      if (Result<void> ok = take(leds, name, exposure_us, kFramesEach); !ok) return ok;
    }
  }
  return {};
}

// One quantity over the seeds.
struct ResponseQuantity {
  const char* name;
  double truth;
  double per_percent;  // error_percent is rms_error over this
  double bar_percent;  // 0: none was asked for
  double sum = 0, square = 0, sigma = 0;

  void add(double measured, double predicted_sigma) {
    sum += measured;
    square += (measured - truth) * (measured - truth);
    sigma += predicted_sigma;
  }
  Json row(const char* body, int seeds) const {
    const double rms = std::sqrt(square / seeds);
    return {{"body", body},
            {"quantity", name},
            {"truth", truth},
            {"measured", sum / seeds},
            {"rms_error", rms},
            {"sigma", sigma / seeds},
            {"error_percent", rms / per_percent},
            {"bar_percent", bar_percent > 0 ? Json(bar_percent) : Json()}};
  }
};

Result<void> measure(const char* name, simulator::Body body, const StudyOptions& options, Rows& rows) {
  const Result<simulator::SceneRig> rig = rig_of(scene_of(body, 1));
  if (!rig) return rig.error();
  const Response truth = response_of(rig->sensor);
  const double full = rig->sensor.white - rig->sensor.black;
  const double noise_bar = body == simulator::Body::kOffset ? 1 : 5;
  const double departure = calibration::departure_from_line(kBend);
  ResponseQuantity gain = {"electrons a count", truth.electrons_per_count, truth.electrons_per_count / 100,
                           noise_bar};
  ResponseQuantity read = {"read noise, counts", truth.read_noise_counts, truth.read_noise_counts / 100,
                           noise_bar};
  ResponseQuantity black = {"black level, counts", rig->sensor.black, full / 100, 0.01};
  ResponseQuantity bend = {"non-linearity, of full scale", departure, 0.01, 0.1};
  ResponseQuantity left = {"non-linearity left, of full scale", 0, 0.01, 0.1};
  ResponseQuantity ratio = {"light at 1.8 over light at 0.45", 4, 0.04, 0};
  JobContext context;
  context.threads = options.threads;
  for (int seed = 1; seed <= options.runs; ++seed) {
    const TemporaryFolder scratch;
    const fs::path input = scratch.path() / "response";
    if (Result<void> ok = capture(scene_of(body, seed), rig->exposure_us, input, options.threads); !ok)
      return ok;
    app::CalibrateResponseOptions job;
    job.input = input;
    job.output = scratch.path() / "calibration";
    job.rig = "bench";
    const Result<app::CalibrateOutcome> done = calibrate_response(job, context);
    if (!done) return done.error();
    const Json& n = done->report.numbers;
    const Response& measured = *done->calibration.response;
    gain.add(measured.electrons_per_count, n["sigma_electrons_per_count"]);
    read.add(measured.read_noise_counts, n["sigma_read_noise_counts"]);
    black.add(n["black_counts"], n["sigma_black_counts"]);
    double worst = 0, sigma = 0;
    std::size_t worst_channel = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [a, b] = measured.linearity[c];
      const double off = calibration::departure_from_line({a - kBend[0], b - kBend[1]});
      if (off > worst) worst_channel = c;
      worst = std::max(worst, off);
      sigma = std::max(sigma, n["sigma_departure"][c].get<double>());
    }
    bend.add(n["departure"][worst_channel], sigma);
    left.add(worst, sigma);
    const double scene_us = rig->exposure_us;
    ratio.add(*measured.exposure_ratio(std::round(1.8 * scene_us), std::round(0.45 * scene_us)), 0);
  }
  for (const ResponseQuantity* q : {&gain, &read, &black, &bend, &left, &ratio})
    rows.push_back(q->row(name, options.runs));
  return {};
}

}  // namespace

/// `weft calibrate response` on simulated captures: a sheet of paper by LED 1, LED 2 and both at seven
/// exposures, two frames of each, and dark frames, as DNG files, by both bodies of the simulator. The sensor
/// is bent by half a percent, uneven, warm and noisy, its LEDs drift, its shutter is off by 0.4 percent. A
/// row a body and quantity: `truth`, `measured` (mean over seeds), `rms_error` and the `sigma` that the
/// calibration predicts for itself, `error_percent` (of the truth; of full scale for black level and
/// linearity) and the `bar_percent` asked for.
Result<Rows> calibration_response_table(const StudyOptions& options) {
  Rows rows;
  for (const auto& [name, body] :
       {std::pair{"offset", simulator::Body::kOffset}, std::pair{"d5100", simulator::Body::kD5100}}) {
    if (Result<void> ok = measure(name, body, options, rows); !ok) return std::move(ok).error();
  }
  return rows;
}

}  // namespace weft::bench
