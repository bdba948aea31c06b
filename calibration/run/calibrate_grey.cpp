// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_grey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "calibration/lights/grey_chart.h"
#include "calibration/lights/physical.h"
#include "calibration/run/calibrate_patches.h"
#include "calibration/run/described.h"
#include "calibration/run/rig_evidence.h"
#include "calibration/run/scale_file.h"
#include "core/base/files.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kBentFrom_sigmas = 4;

Error unusable(const fs::path& where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "the grey scale cannot be used", where.string(), std::move(why),
          std::move(remedy)};
}

/// The patches of a row between its outer corners: as if seen from straight above, which is within the border
/// of a patch that is not read.
Result<std::vector<WhitePatch>> patches_in(const ScaleSettings& scale, const fs::path& file, Size frame) {
  if (!scale.corners_px) {
    return unusable(file, "it has no corners_px",
                    "name the outer corners of the row of patches, clockwise from the first patch");
  }
  const ChartCorners& corners = *scale.corners_px;
  for (const auto& [x, y] : corners) {
    if (!(x >= 0 && y >= 0 && x < frame.width && y < frame.height)) {
      return unusable(file, fmt::format("corner ({:.0f}, {:.0f}) is outside the frame", x, y),
                      "give corners_px in pixels of the raw frame");
    }
  }
  const auto count = scale.reflectances.size();
  const double length = static_cast<double>(count) - 1 + kPatchShare;
  std::vector<WhitePatch> patches;
  for (std::size_t i = 0; i < count; ++i) {
    const double from = static_cast<double>(i) / length, to = from + kPatchShare / length;
    const auto on = [&](std::size_t a, std::size_t b, double t) {
      return std::array{corners[a][0] + t * (corners[b][0] - corners[a][0]),
                        corners[a][1] + t * (corners[b][1] - corners[a][1])};
    };
    patches.push_back({{on(0, 1, from), on(0, 1, to), on(3, 2, to), on(3, 2, from)}});
  }
  return patches;
}

Result<GreyChartFit> fit(Calibration calibration, const solve::Photographs& photographs,
                         const ScaleSettings& scale, std::vector<WhitePatch> patches) {
  calibration.patches = std::move(patches);
  const Result<RigSightings> seen = sightings_in(calibration, photographs);
  if (!seen) return seen.error();
  const RigEvidence evidence = evidence_of(calibration, *seen);
  std::vector<GreyPatch> greys;
  for (std::size_t i = 0; i < evidence.places.size(); ++i) {
    const LitPlace& place = evidence.places[i];
    greys.push_back({place.x_px, place.y_px, scale.reflectances[i], place.reading_rgb});
  }
  const NearLights& lights = std::get<NearLights>(*calibration.lights);
  std::vector<double> full_reading(lights.leds.size(), 1);
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    const ShotMetadata& shot = photographs.mosaics()->frames[k].shot;
    full_reading[static_cast<std::size_t>(photographs.leds[k] - 1)] =
        1 / (1e-6 * shot.exposure_us * shot.iso / 100);
  }
  GreyChartOptions options;
  options.height_mm = scale.height_mm;
  options.reflectance_sigma = scale.reflectance_sigma;
  options.delta = scale.delta;
  return fit_grey_chart(*calibration.camera, lights, greys, full_reading, options);
}

/// What was known of places stays, and what the fluxes owe to it; the chart's own part comes on top.
std::optional<ParameterCovariance> with_chart(std::optional<ParameterCovariance> covariance,
                                              const GreyChartFit& fit) {
  if (!covariance) return {};
  const std::size_t n = covariance->parameters.size(), leds = fit.lights.leds.size();
  std::vector<std::size_t> place;
  for (std::size_t k = 0; k < leds; ++k) {
    const auto& names = covariance->parameters;
    const auto found = std::find(names.begin(), names.end(), fmt::format("led{:02}.log_flux", k + 1));
    place.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  for (std::size_t k = 0; k < leds; ++k) {
    for (std::size_t l = 0; l < leds; ++l) {
      if (place[k] < n && place[l] < n)
        covariance->matrix[place[k] * n + place[l]] += fit.log_flux_covariance[k * leds + l];
    }
  }
  return covariance;
}

report::Section led_section(const GreyChartFit& fit, const NearLights& before, Json& numbers) {
  report::Section section = {
      "LEDs",
      {"Flux in green, and red and blue over it: the white balance. Sigmas are for LEDs "
       "at the places that the calibration has."},
      report::Table{{"LED", "flux, green", "sigma, %", "red / green", "sigma, %", "blue / green", "sigma, %",
                     "green over before, %"},
                    {}},
      {},
      true};
  for (std::size_t k = 0; k < fit.lights.leds.size(); ++k) {
    const auto& flux = fit.lights.leds[k].flux_rgb;
    const double over = flux[1] / before.leds[k].flux_rgb[1] - 1;
    section.table->rows.push_back(
        {std::to_string(k + 1), fmt::format("{:.5g}", flux[1]),
         fmt::format("{:.2f}", 100 * fit.flux_sigma[k][1]), fmt::format("{:.4f}", flux[0] / flux[1]),
         fmt::format("{:.2f}", 100 * fit.balance_sigma[k][0]), fmt::format("{:.4f}", flux[2] / flux[1]),
         fmt::format("{:.2f}", 100 * fit.balance_sigma[k][1]), fmt::format("{:+.2f}", 100 * over)});
    numbers["leds"].push_back({{"led", k + 1},
                               {"flux_rgb", flux},
                               {"relative_sigma", fit.flux_sigma[k]},
                               {"balance", {flux[0] / flux[1], flux[2] / flux[1]}},
                               {"balance_relative_sigma", fit.balance_sigma[k]},
                               {"green_over_before", over}});
  }
  return section;
}

report::Section patch_section(const GreyChartFit& fit, const ScaleSettings& scale) {
  report::Section section = {
      "Patches",
      {fmt::format(
          "How far each patch is from its reflectance. Linear light would be v (1 {:+.4f} v) of what "
          "was read, with a sigma of {:.4f}; chi-square a degree of freedom is {:.2f}.",
          fit.bend, fit.bend_sigma, fit.chi_square)},
      report::Table{{"patch", "reflectance", "off, %"}, {}}};
  for (std::size_t i = 0; i < fit.off_percent.size(); ++i) {
    section.table->rows.push_back({std::to_string(i + 1), fmt::format("{:.4f}", scale.reflectances[i]),
                                   fmt::format("{:+.2f}", fit.off_percent[i])});
  }
  return section;
}

CalibrationReport report_of(const GreyChartFit& fit, const Calibration& before, const ScaleSettings& scale) {
  CalibrationReport report;
  report.part = "grey";
  report.title = fmt::format("LEDs of {} by a grey scale", before.subject.rig);
  double sigma = 0;
  for (const auto& of_led : fit.flux_sigma) sigma = std::max(sigma, of_led[1]);
  report.summary =
      fmt::format("{} LEDs by {} patches, fluxes to {:.2f} percent, bend {:+.4f} +- {:.4f}",
                  fit.flux_sigma.size(), fit.off_percent.size(), 100 * sigma, fit.bend, fit.bend_sigma);
  if (fit.chi_square > kMisfitFrom) {
    report.verdicts.push_back(
        {"GREY_MISFIT",
         fmt::format("the patches contradict each other: chi-square is {:.1f}", fit.chi_square),
         "see that no patch shines or lies in shadow, and calibrate the lights' places"});
  }
  if (std::abs(fit.bend) > kBentFrom_sigmas * fit.bend_sigma) {
    report.verdicts.push_back(
        {"RESPONSE_BENT",
         fmt::format("full scale is {:+.1f} percent off a straight line, {:.0f} standard deviations",
                     -100 * fit.bend, std::abs(fit.bend) / fit.bend_sigma),
         "measure the linearity by weft calibrate response, and the reflectances of the patches"});
  }
  report.numbers = {{"bend", fit.bend},
                    {"sigma_bend", fit.bend_sigma},
                    {"chi_square", fit.chi_square},
                    {"reflectances", scale.reflectances},
                    {"off_percent", fit.off_percent}};
  report.sections = {led_section(fit, std::get<NearLights>(*before.lights), report.numbers),
                     patch_section(fit, scale)};
  return report;
}

}  // namespace

void describe(Fields& fields, CalibrateGreyOptions& o) {
  fields.value({.name = "session",
                .says = "A scan of the scale, flat on the table",
                .need = kMustSay,
                .path = PathTo::kSession,
                .option = ""},
               o.session);
  fields.value({.name = "scale",
                .says = "scale.toml: where it lies; default beside the session",
                .path = PathTo::kFile},
               o.scale);
  fields.value({.name = "from",
                .says = "The calibration to change; default the session's own",
                .path = PathTo::kFolder},
               o.from);
  describe_new_calibration(fields, o.output);
}

Result<CalibrateOutcome> calibrate_grey(const CalibrateGreyOptions& options, const JobContext& context) {
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  const Result<solve::SolvePlan> plan = solve::plan_session({options.session, options.from, {}});
  if (!plan) return plan.error();
  const Calibration& before = plan->calibration;
  if (!std::holds_alternative<NearLights>(*before.lights) || !plan->raw) {
    return unusable(options.session, plan->raw ? "the calibration's lights are distant" : "it was developed",
                    "scan the scale as raw frames, with a calibration that says where the LEDs are");
  }
  const fs::path file =
      options.scale.empty() ? absolute_folder(options.session).parent_path() / "scale.toml" : options.scale;
  const Result<ScaleSettings> scale = read_scale_file(file);
  if (!scale) return scale.error();
  Result<std::vector<WhitePatch>> patches = patches_in(*scale, file, plan->size);
  if (!patches) return std::move(patches).error();
  const Result<solve::Photographs> loaded = solve::load_photographs(*plan, context);
  if (!loaded) return loaded.error();
  const Result<GreyChartFit> found = fit(before, *loaded, *scale, std::move(*patches));
  if (!found) return found.error();

  CalibrateOutcome outcome;
  outcome.report = report_of(*found, before, *scale);
  if (!before.patches.empty()) outcome.warnings.push_back(patches_left_out("lights"));
  Calibration change;
  change.subject = before.subject;
  change.subject.measured.clear();
  change.subject.albedo_scale = AlbedoScale::kAbsolute;
  change.lights = found->lights;
  change.light_covariance = with_chart(before.light_covariance, *found);
  change.points = before.points;
  const fs::path from = options.from.empty() ? options.session / "calibration" : options.from;
  Result<Calibration> written =
      derive_calibration(from, std::move(change), options.output, report_files(outcome.report));
  if (!written) return std::move(written).error();
  outcome.folder = options.output;
  outcome.calibration = std::move(*written);
  return outcome;
}

}  // namespace weft::calibration
