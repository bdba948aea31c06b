// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/studies.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <string>
#include <vector>

#include "app/jobs/calibrate/color.h"
#include "calibration/color/color_fit.h"
#include "core/color_transform.h"
#include "core/files.h"
#include "core/temporary_folder.h"
#include "simulator/scene/rig.h"
#include "simulator/simulate.h"
#include "simulator/spectra/observer.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using simulator::Spectrum;

constexpr double kCiede2000Bar = 1;
constexpr const char* kSpectra = "testdata/spectra";  // tables of LED, filters, chart and dyes

struct Spectra {
  Spectrum led;
  simulator::Filters filters;
  std::vector<Spectrum> chart, dyes;
};

Result<Spectra> read_all(const fs::path& folder) {
  Spectra all;
  Result<Spectrum> led = simulator::read_spectrum(folder / "led_white.txt");
  if (!led) return std::move(led).error();
  all.led = *led;
  for (const auto& [c, name] :
       {std::pair{0, "filter_red.txt"}, {1, "filter_green.txt"}, {2, "filter_blue.txt"}}) {
    Result<Spectrum> filter = simulator::read_spectrum(folder / name);
    if (!filter) return std::move(filter).error();
    all.filters[static_cast<std::size_t>(c)] = *filter;
  }
  Result<std::vector<Spectrum>> chart = simulator::read_spectra(folder / "chart", 24);
  if (!chart) return std::move(chart).error();
  all.chart = std::move(*chart);
  std::vector<fs::path> dyes;
  std::error_code failed;
  for (fs::directory_iterator it(folder / "dye", failed), end; !failed && it != end; it.increment(failed)) {
    dyes.push_back(it->path());
  }
  std::sort(dyes.begin(), dyes.end());
  for (const fs::path& file : dyes) {
    Result<Spectrum> dye = simulator::read_spectrum(file);
    if (!dye) return std::move(dye).error();
    all.dyes.push_back(*dye);
  }
  return all;
}

using Space = Eigen::Matrix<double, Spectrum::kSamples, 3>;

double vora(const Space& observer, const Space& camera) {
  const auto basis = [](const Space& space) -> Space {
    return space.householderQr().householderQ() * Space::Identity();
  };
  return (basis(observer).transpose() * basis(camera)).squaredNorm() / 3;
}

Space space_of(const simulator::ChannelWeights& weights) {
  Space space;
  for (Eigen::Index c = 0; c < 3; ++c) {
    for (Eigen::Index i = 0; i < space.rows(); ++i) {
      space(i, c) = weights[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)];
    }
  }
  return space;
}

// The observer under D65, and with the light divided out.
struct Vora {
  double bare = 0, lit = 0;
};

Result<Vora> vora_of(const Spectra& spectra) {
  const Result<simulator::ChannelWeights> lit = simulator::camera_weights(spectra.led, spectra.filters);
  const Result<simulator::ChannelWeights> bare =
      simulator::camera_weights(simulator::flat_spectrum(1), spectra.filters);
  if (!lit) return lit.error();
  if (!bare) return bare.error();
  return Vora{vora(space_of(simulator::observer_weights()), space_of(*bare)),
              vora(space_of(simulator::rec709_weights()), space_of(*lit))};
}

simulator::Scene scene_of(const Spectra& spectra) {
  simulator::Scene scene;
  scene.fabric = "colour chart";
  scene.camera.width = 616;
  scene.camera.height = 408;
  scene.camera.mm_per_pixel = 0.35;
  scene.material.albedo = {0.03, 0.03, 0.03};
  scene.spectra.led = spectra.led;
  scene.spectra.filters = spectra.filters;
  scene.spectra.chart = spectra.chart;
  simulator::TargetSettings chart;
  chart.pattern = simulator::ChartSettings{};
  chart.centre_mm.z = 1;
  scene.geometry.cloth_height_mm = 1;
  scene.targets = {chart};
  simulator::EffectSettings& e = scene.effects;
  e.near_light = e.spectral = e.noise = true;
  return scene;
}

std::string chart_toml(const Spectra& spectra) {
  std::string toml = "rec709 = [\n";
  for (const Spectrum& patch : spectra.chart) {
    const Rgb rgb = simulator::rec709_albedo(patch);
    toml += fmt::format("  [{}, {}, {}],\n", rgb[0], rgb[1], rgb[2]);
  }
  return toml + "]\n";
}

// Mean CIEDE2000 of what a transform makes of each dye.
Result<double> off_dyes(const Spectra& spectra, const ColorTransform& transform) {
  const Result<simulator::ChannelWeights> camera = simulator::camera_weights(spectra.led, spectra.filters);
  if (!camera) return camera.error();
  double sum = 0;
  for (const Spectrum& dye : spectra.dyes) {
    sum +=
        calibration::ciede2000_of(rec709_of_camera(transform, simulator::channel_reflectance(*camera, dye)),
                                  simulator::rec709_albedo(dye));
  }
  return sum / static_cast<double>(std::max<std::size_t>(spectra.dyes.size(), 1));
}

}  // namespace

/// `weft calibrate color` on the simulated 24-patch chart through spectral filters and noise: as a session
/// that is solved, and as one photograph under one LED, by matrix and by the curve in xyY. `vora` is how much
/// of the observer's space the filters span, trace(P P') / 3 of the projections on both (Vora and Trussell
/// 1993); `vora_lit` the same with the LED behind the filters and daylight behind the observer. Then
/// CIEDE2000, mean over patches: of the camera's own colours, fitted, of held-out patches (each by the fit to
/// all others; `bar` is asked for), and of the cloth dyes of the folder, which no fit has seen.
Result<Rows> calibration_color_table(const StudyOptions& options) {
  const Result<Spectra> spectra = read_all(kSpectra);
  if (!spectra) return spectra.error();
  const Result<Vora> span = vora_of(*spectra);
  if (!span) return span.error();
  const simulator::Scene scene = scene_of(*spectra);
  const TemporaryFolder scratch;
  simulator::SimulateOptions simulate;
  simulate.tiles.threads = options.threads;
  const fs::path session = scratch.path() / "session", photograph = scratch.path() / "photograph";
  for (const fs::path& folder : {session, photograph}) {
    if (Result<void> ok = make_writable_folder(folder); !ok) return std::move(ok).error();
    if (Result<void> ok = write_file(folder / "chart.toml", chart_toml(*spectra)); !ok)
      return std::move(ok).error();
  }
  if (const auto done = simulate_session(scene, session / "chart.weft", simulate); !done) return done.error();
  if (const auto done = simulate_frame(scene, 1, photograph / "led01.dng", simulate); !done)
    return done.error();

  JobContext context;
  context.threads = options.threads;
  Rows rows;
  for (const auto& [name, input] : {std::pair{"session", session}, std::pair{"photograph", photograph}}) {
    app::CalibrateColorOptions job;
    job.input = input;
    job.from = session / "chart.weft" / "calibration";
    job.curve = true;
    job.output = scratch.path() / fmt::format("{}-calibration", name);
    const Result<app::CalibrateOutcome> done = calibrate_color(job, context);
    if (!done) return done.error();
    const Json& n = done->report.numbers;
    const ColorTransform by_curve = *done->calibration.color;
    ColorTransform by_matrix = by_curve;
    by_matrix.curve.reset();
    for (const bool curve : {false, true}) {
      const Result<double> dyes = off_dyes(*spectra, curve ? by_curve : by_matrix);
      if (!dyes) return dyes.error();
      rows.push_back({{"input", name},
                      {"transform", curve ? "curve" : "matrix"},
                      {"vora", span->bare},
                      {"vora_lit", span->lit},
                      {"before", n["mean_before"]},
                      {"fitted", n[curve ? "mean_by_curve" : "mean_after"]},
                      {"held_out", n[curve ? "mean_by_curve_held_out" : "mean_held_out"]},
                      {"bar", kCiede2000Bar},
                      {"dyes", *dyes}});
    }
  }
  return rows;
}

}  // namespace weft::bench
