// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/studies.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "bench/oracles/grey_oracle.h"
#include "calibration/lights/grey_chart.h"
#include "calibration/lights/physical.h"
#include "calibration/response/neutral_scale.h"
#include "core/parallel.h"

namespace weft::bench {
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

}  // namespace weft::bench
