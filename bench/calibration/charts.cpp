// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/calibration_studies.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/oracles/board_views.h"
#include "bench/oracles/grey_oracle.h"
#include "bench/oracles/paper_oracle.h"
#include "calibration/camera/lens_fit.h"
#include "calibration/color/color_fit.h"
#include "calibration/lights/grey_chart.h"
#include "calibration/lights/physical.h"
#include "calibration/lights/sheet_blocks.h"
#include "calibration/response/neutral_scale.h"
#include "calibration/run/calibrate_color.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "core/rig/color_transform.h"
#include "simulator/scene/scene_rig.h"
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
    calibration::CalibrateColorOptions job;
    job.input = input;
    job.from = session / "chart.weft" / "calibration";
    job.curve = true;
    job.output = scratch.path() / fmt::format("{}-calibration", name);
    const Result<calibration::CalibrateOutcome> done = calibrate_color(job, context);
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

namespace {

using calibration::GreyChartFit;
using test::GreyErrors;
using test::PaperRig;

constexpr double kErrorOverSigmaBar = 1.3;

/// Sums of squares of one quantity.
struct Score {
  double error2 = 0, sigma2 = 0, ratio2 = 0, count = 0;

  void add(double error, double sigma) {
    error2 += error * error;
    sigma2 += sigma * sigma;
    ratio2 += error * error / (sigma * sigma);
    ++count;
  }
};

std::vector<GreyChartFit> fits_of(const PaperRig& rig, const CameraModel& camera, const NearLights& lights,
                                  const StudyOptions& options, double bend) {
  std::vector<GreyChartFit> fits(static_cast<std::size_t>(options.runs));
  parallel_for(fits.size(), options.threads, [&](std::size_t i, int) {
    GreyErrors errors;
    errors.seed = i + 1;
    errors.bend = bend;
    const test::GreyCapture capture = test::greys_of(rig, errors);
    fits[i] = *fit_grey_chart(camera, lights, capture.patches, capture.full_reading);
  });
  return fits;
}

Json row_of(const std::string& name, const char* quantity, const Score& score) {
  return {{"case", name},
          {"quantity", quantity},
          {"rms_error", 100 * std::sqrt(score.error2 / score.count)},
          {"sigma", 100 * std::sqrt(score.sigma2 / score.count)},
          {"error_over_sigma", std::sqrt(score.ratio2 / score.count)},
          {"bar", kErrorOverSigmaBar},
          {"free_parabola", Json()}};
}

void add_fluxes(Rows& rows, const std::string& name, const std::vector<GreyChartFit>& fits,
                const NearLights& truth) {
  Score flux, balance;
  for (const GreyChartFit& fit : fits) {
    for (std::size_t k = 0; k < truth.leds.size(); ++k) {
      std::array<double, 3> off = {};
      for (std::size_t c = 0; c < 3; ++c) {
        off[c] = std::log(fit.lights.leds[k].flux_rgb[c] / truth.leds[k].flux_rgb[c]);
        flux.add(off[c], fit.flux_sigma[k][c]);
      }
      balance.add(off[0] - off[1], fit.balance_sigma[k][0]);
      balance.add(off[2] - off[1], fit.balance_sigma[k][1]);
    }
  }
  rows.push_back(row_of(name, "flux", flux));
  rows.push_back(row_of(name, "balance", balance));
}

/// What a parabola of light along the chart leaves of a bend, by the chart under its brightest LED.
double left_by_parabola(const PaperRig& rig, double bend) {
  const test::GreyCapture capture = test::greys_of(rig, {0, 0, 0, 0, 0, 0, bend, 1});
  std::vector<double> reflectances;
  std::vector<std::array<double, 3>> v;
  for (const calibration::GreyPatch& patch : capture.patches) {
    reflectances.push_back(patch.reflectance);
    std::array<double, 3>& rgb = v.emplace_back(patch.reading_rgb[0]);
    for (double& value : rgb) value /= capture.full_reading[0];
  }
  return calibration::check_scale(reflectances, v)->rms_percent;
}

void add_bend(Rows& rows, const PaperRig& rig, const std::vector<GreyChartFit>& fits, double bend) {
  double mean = 0, sigma2 = 0, ratio2 = 0;
  const auto n = static_cast<double>(fits.size());
  for (const GreyChartFit& fit : fits) {
    mean -= fit.bend / n;
    sigma2 += fit.bend_sigma * fit.bend_sigma / n;
    ratio2 += std::pow(fit.bend / fit.bend_sigma, 2) / n;
  }
  rows.push_back({{"case", fmt::format("response bent by {:.0f} percent", 100 * bend)},
                  {"quantity", "bend"},
                  {"rms_error", 100 * mean},
                  {"sigma", 100 * std::sqrt(sigma2)},
                  {"error_over_sigma", std::sqrt(ratio2)},
                  {"bar", bend == 0 ? Json(kErrorOverSigmaBar) : Json()},
                  {"free_parabola", left_by_parabola(rig, bend)}});
}

}  // namespace

/// Fluxes and white balances of ten LEDs from a chart of the nine greys of the Munsell scale, made by
/// formulas of their own (bench/oracles/grey_oracle.h). A row a case and quantity: "flux" and "balance"
/// (percent), with LEDs at their true places against the truth, and with LEDs as five poses of white paper
/// found them against what the paper found; then "bend" (percent of the light at full scale) of a response
/// bent by 0 to 100 percent. `rms_error` (of a bend: its mean), the `sigma` that the fit predicts, the
/// Cramer-Rao bound, `error_over_sigma`, the `bar` asked for; for bends `free_parabola`: what
/// calibration::check_scale leaves of it, percent rms.
Result<Rows> calibration_grey_table(const StudyOptions& options) {
  if (options.runs < 1 || options.runs > 10000) {
    return Error{ErrorKind::kUsage, "number of seeds is out of its range", "seeds", "it is 1 to 10000",
                 "give a number in that range"};
  }
  PaperRig rig = test::common_rig();
  const test::PaperCaptures paper = test::captures_of(rig, {});
  const auto by_paper = fit_lights(paper.start, paper.readings, {});
  if (!by_paper) return by_paper.error();
  Rows rows;
  const CameraModel& camera = paper.start.camera;
  const NearLights& found = by_paper->scene.lights;
  const std::vector<GreyChartFit> against_paper = fits_of(rig, camera, found, options, 0);
  rig.vignette = 0;
  add_fluxes(rows, "LEDs known exactly", fits_of(rig, camera, rig.lights, options, 0), rig.lights);
  add_fluxes(rows, "LEDs by five poses of paper, against the paper", against_paper, found);
  for (const double bend : {0.0, 0.1, 0.3, 0.6, 1.0})
    add_bend(rows, rig, fits_of(rig, camera, rig.lights, options, bend), bend);
  return rows;
}

namespace {

using calibration::BoardView;
using calibration::LensFit;
using calibration::LightFit;
using calibration::Pose;
using test::BoardRig;

constexpr double kCorner_px = 0.1;

/// What a fit that was accepted is off by.
struct Outcome {
  std::vector<double> errors, sigmas;  ///< alike in number
  std::optional<double> chi_square;

  void add(double error, double sigma) {
    errors.push_back(error);
    sigmas.push_back(sigma);
  }
};

struct DegenerateCase {
  std::string name, kind, unit;
  std::function<std::optional<Outcome>(int seed)> run;  ///< nothing: refused
};

/// 8 x 5 blocks, each with the noise of the eleven that it stands for of 26 x 17.
std::optional<Outcome> lights(const PaperRig& rig, int seed) {
  test::PaperErrors errors;
  errors.seed = static_cast<std::uint64_t>(seed);
  errors.noise = 0.002 / std::sqrt(11.0);
  const test::PaperCaptures captures = test::captures_of(rig, errors, 8, 5);
  const Result<LightFit> fit = fit_lights(captures.start, captures.readings, {});
  if (!fit || fit->misfits()) return {};
  Outcome outcome;
  outcome.chi_square = fit->chi_square;
  for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
    const Vec3 off = fit->scene.lights.leds[k].position_mm - rig.lights.leds[k].position_mm;
    const Vec3 sigma = fit->position_sigma_mm[k];
    outcome.add(off.x, sigma.x);
    outcome.add(off.y, sigma.y);
    outcome.add(off.z, sigma.z);
  }
  return outcome;
}

std::optional<Outcome> camera(const BoardRig& rig, const std::vector<BoardView>& views,
                              const calibration::LensOptions& options = {}) {
  const Result<LensFit> fit = fit_lens(views, rig.camera.size, options);
  if (!fit) return {};
  Outcome outcome;
  outcome.chi_square = std::pow(fit->corner_sigma_px / kCorner_px, 2);
  const auto add = [&](double CameraModel::*value) {
    outcome.add(fit->camera.*value - rig.camera.*value,
                calibration::propagated(fit->camera, fit->covariance,
                                        [=](const CameraModel& c) { return c.*value; }));
  };
  for (double CameraModel::*value : {&CameraModel::fx, &CameraModel::fy, &CameraModel::cx, &CameraModel::cy})
    add(value);
  return outcome;
}

/// A frame of white paper, every photosite with noise of its own, averaged in blocks and those to one.
std::optional<Outcome> sum(int seed) {
  constexpr Size kFrame = {16384, 6400};
  constexpr int kSide = 16;
  constexpr float kWhite = 1e6f, kNoise = 3e3f;  // a float has 24 bits: its own sum would end at 1.7e13
  calibration::SheetBlockGrid grid(kFrame, kSide);
  Image<float> band({kFrame.width, kSide});
  std::uint64_t state = static_cast<std::uint64_t>(seed);
  std::vector<std::array<int, 2>> places;
  for (int row = 0; row < grid.rows; ++row) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        state = 6364136223846793005u * state + 1442695040888963407u;  // Knuth, MMIX
        band(x, y) = kWhite + kNoise * (static_cast<float>(state >> 40) * 0x1p-23f - 1);
      }
    }
    average_row(grid, row, band.plane(), CfaPattern{});
    for (int column = 0; column < grid.columns; ++column) places.push_back({column, row});
  }
  const calibration::MergedBlock merged = merge(grid, places);
  Outcome outcome;
  for (std::size_t c = 0; c < 3; ++c)
    outcome.add(merged.reading_rgb[c] / kWhite - 1, merged.relative_sigma[c]);
  return outcome;
}

std::vector<DegenerateCase> all_cases() {
  const PaperRig common = test::common_rig();
  PaperRig low = common, edge_on = common, on_axis = common, equal = common, one = common;
  low.sheets = test::lies(5, 1.5);
  edge_on.sheets.back().tilt_deg = 84;
  on_axis.lights.leds[0].position_mm = {0, 0, 590};
  on_axis.lights.leds[0].aim = {0, 0, -1};
  equal.sheets.assign(5, {});
  one.sheets = test::lies(1);
  PaperRig one_not_lambertian = one;
  one_not_lambertian.delta = 0.05;
  const auto lights_of = [](const PaperRig& rig) { return [rig](int seed) { return lights(rig, seed); }; };

  BoardRig low_boards, edge_on_board;
  low_boards.tilts_deg = {1.5, 0.9, 0.45};
  edge_on_board.tilts_deg = {30, 84, 25};
  const auto boards = [](const BoardRig& rig, const calibration::LensOptions& options = {}) {
    return [rig, options](int seed) { return camera(rig, views_of(rig, kCorner_px, seed), options); };
  };
  const auto again = [](int seed) {
    const BoardRig rig;
    const std::vector<Pose> poses(static_cast<std::size_t>(rig.boards), poses_of(rig, seed)[1]);
    return camera(rig, views_of(rig, poses, kCorner_px, seed));
  };
  const auto once = [](int seed) {
    const BoardRig rig;
    return camera(rig, views_of(rig, {poses_of(rig, seed)[0]}, kCorner_px, seed));
  };
  return {
      {"all tilts under 2 degrees", "lights", "mm", lights_of(low)},
      {"all tilts under 2 degrees", "camera", "px", boards(low_boards)},
      {"all tilts under 2 degrees, told to accept 3 percent of focal length", "camera", "px",
       boards(low_boards, {.most_focal_sigma = 0.03})},
      {"seen edge-on, 84 degrees: one sheet of five", "lights", "mm", lights_of(edge_on)},
      {"seen edge-on, 84 degrees: every third board", "camera", "px", boards(edge_on_board)},
      {"a LED on the optical axis", "lights", "mm", lights_of(on_axis)},
      {"one pose, five times", "lights", "mm", lights_of(equal)},
      {"one pose, fifteen times", "camera", "px", again},
      {"one flat sheet", "lights", "mm", lights_of(one)},
      {"one flat sheet, paper 5 percent off Lambert's law", "lights", "mm", lights_of(one_not_lambertian)},
      {"one flat board", "camera", "px", once},
      {"mean of 105 megapixels", "sum", "of white", sum}};
}

Json row_of(const DegenerateCase& c, const std::vector<std::optional<Outcome>>& outcomes) {
  double squares = 0, variances = 0, worst = 0, n = 0;
  int refused = 0;
  std::optional<double> least, most;
  for (const auto& outcome : outcomes) {
    if (!outcome) {
      ++refused;
      continue;
    }
    for (std::size_t i = 0; i < outcome->errors.size(); ++i, ++n) {
      const double sigma = outcome->sigmas[i], over = std::abs(outcome->errors[i]) / sigma;
      squares += over * over;
      variances += sigma * sigma;
      worst = std::max(worst, over);
    }
    if (!outcome->chi_square) continue;
    least = std::min(least.value_or(*outcome->chi_square), *outcome->chi_square);
    most = std::max(most.value_or(*outcome->chi_square), *outcome->chi_square);
  }
  const auto told = [](bool known, double value) { return known ? Json(value) : Json(); };
  return {{"case", c.name},
          {"kind", c.kind},
          {"seeds", outcomes.size()},
          {"refused", refused},
          {"predicted sigma, rms", told(n > 0, std::sqrt(variances / n))},
          {"unit", c.unit},
          {"error over sigma, rms", told(n > 0, std::sqrt(squares / n))},
          {"error over sigma, worst", told(n > 0, worst)},
          {"chi-square, least", told(least.has_value(), least.value_or(0))},
          {"chi-square, most", told(most.has_value(), most.value_or(0))},
          {"asked", "refused, or within its sigma"}};
}

}  // namespace

/// Captures that cannot say what is asked of them: all tilts under 2 degrees, a board or sheet seen edge-on,
/// a LED on the optical axis, one pose taken again and again, one sheet or board, the sum of 100 megapixels.
/// A row a case and kind ("lights": positions of LEDs, "camera": focal lengths and principal point, "sum":
/// the mean of white paper by channel), made by formulas of their own (bench/oracles/paper_oracle.h,
/// bench/oracles/board_views.h): in how many of `seeds` it is `refused` (by an error or as a misfit), and of
/// those accepted the predicted sigma (rms, in `unit`), the error over it (rms and worst) and the least and
/// most chi-square a degree of freedom, where the fit has one. The camera's is of the corners' noise that was
/// put in.
Result<Rows> calibration_degenerate_table(const StudyOptions& options) {
  if (options.runs < 1 || options.runs > 1000) {
    return Error{ErrorKind::kUsage, "number of seeds is out of its range", "seeds", "it is 1 to 1000",
                 "give a number in that range"};
  }
  Rows rows;
  for (const DegenerateCase& c : all_cases()) {
    std::vector<std::optional<Outcome>> outcomes(static_cast<std::size_t>(options.runs));
    parallel_for(outcomes.size(), options.threads,
                 [&](std::size_t i, int) { outcomes[i] = c.run(static_cast<int>(i) + 1); });
    rows.push_back(row_of(c, outcomes));
  }
  return rows;
}

}  // namespace weft::bench
