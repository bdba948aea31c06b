// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/jobs/calibrate/check_result.h"
#include "app/jobs/calibrate/rig_evidence.h"
#include "app/jobs/calibrate/sheet_files.h"
#include "app/jobs/session_input.h"
#include "calibration/checks/light_at.h"
#include "calibration/lights/paper_model.h"
#include "core/files.h"
#include "core/toml/toml_keys.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
constexpr double kMostSpread = 0.1;

Error bad_patches(const std::string& where, std::string why) {
  return {ErrorKind::kBadData, "white patches cannot be used", where, std::move(why),
          "give each [[patch]] a polygon_px of three corners or more inside the frame"};
}

Result<std::vector<WhitePatch>> read_patches(const fs::path& file, Size frame) {
  const Result<toml::table> table = read_toml(file);
  if (!table) return table.error();
  TomlKeys keys(*table, file.string(), kCalibrationPage);
  keys.know({"patch"});
  const std::vector<const toml::table*> list = keys.tables("patch");
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  std::vector<WhitePatch> patches;
  for (const toml::table* entry : list) {
    WhitePatch& patch = patches.emplace_back();
    const auto where = fmt::format("{}: patch {}", file.string(), patches.size());
    TomlKeys patch_keys(*entry, where, kCalibrationPage);
    patch_keys.know({"polygon_px"});
    if (Result<void> ok = patch_keys.status(); !ok) return std::move(ok).error();
    const toml::array* corners = entry->get_as<toml::array>("polygon_px");
    if (corners == nullptr) return bad_patches(where, "it has no polygon_px");
    for (const toml::node& corner : *corners) {
      const toml::array* xy = corner.as_array();
      if (xy == nullptr || xy->size() != 2) return bad_patches(where, "a corner is not [x, y]");
      const auto x = (*xy)[0].value<double>(), y = (*xy)[1].value<double>();
      if (!x || !y || !(*x >= 0 && *x < frame.width && *y >= 0 && *y < frame.height))
        return bad_patches(where, "a corner lies outside the frame");
      patch.polygon_px.push_back({*x, *y});
    }
    if (patch.polygon_px.size() < 3) return bad_patches(where, "it has fewer than three corners");
  }
  return patches;
}

/// Reflectance of a place by the light of each LED, means of those that can be read.
struct Reflectance {
  std::array<double, 3> rgb = {};
  double least = 1e9, most = 0;  ///< of all LEDs, green
  int leds = 0;
};

Reflectance reflectance_of(const calibration::LitPlace& place, const NearLights& lights, Size frame,
                           double delta) {
  Reflectance out;
  const auto [u, v] = calibration::frame_place(frame, place.x_px, place.y_px);
  for (std::size_t k = 0; k < std::min(lights.leds.size(), place.reading_rgb.size()); ++k) {
    const auto light = calibration::light_at(lights.leds[k], place.point_mm);
    const double cosine = light ? dot(light->direction, place.normal) : 0;
    if (!(cosine > 0)) continue;
    std::array<double, 3> rgb = {};
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const double white = lights.leds[k].flux_rgb[channel] *
                           std::exp(light->log_geometry + lights.log_gain(k, c, u, v)) * cosine *
                           (1 - delta * (1 - cosine));
      rgb[channel] = place.reading_rgb[k][channel] / white;
    }
    if (!std::isfinite(rgb[0] + rgb[1] + rgb[2])) continue;
    for (std::size_t c = 0; c < 3; ++c) out.rgb[c] += rgb[c];
    out.least = std::min(out.least, rgb[1]);
    out.most = std::max(out.most, rgb[1]);
    ++out.leds;
  }
  for (double& r : out.rgb) r /= std::max(out.leds, 1);
  return out;
}

struct MeasuredPatch {
  std::array<double, 3> reflectance_rgb = {};
  double spread = 0;  ///< of the reflectance from LED to LED, as a share of it
};

Result<std::vector<MeasuredPatch>> measure_patches(const Calibration& calibration,
                                                   const pipeline::Photographs& photographs,
                                                   const fs::path& file, double paper_delta) {
  const auto evidence = rig_evidence(calibration, photographs);
  if (!evidence) return evidence.error();
  std::vector<MeasuredPatch> measured;
  for (std::size_t p = 0; p < calibration.patches.size(); ++p) {
    const Reflectance r = reflectance_of(evidence->places[p], std::get<NearLights>(*calibration.lights),
                                         photographs.size, paper_delta);
    const std::string where = fmt::format("{}: patch {}", file.string(), p + 1);
    if (r.leds < 3) return bad_patches(where, "fewer than three LEDs light it, or it is saturated");
    const double spread = (r.most - r.least) / r.rgb[1];
    if (spread > kMostSpread) {
      return bad_patches(where,
                         fmt::format("its reflectance differs by {:.1f} percent from LED to LED: it is not "
                                     "white, flat and in the light",
                                     100 * spread));
    }
    measured.push_back({r.rgb, spread});
  }
  return measured;
}

CalibrationReport report_of(const std::vector<MeasuredPatch>& measured, const std::string& rig) {
  CalibrationReport out;
  out.part = "patches";
  out.title = fmt::format("White patches of {}", rig);
  out.summary = fmt::format("{} patches measured", measured.size());
  report::Table table = {{"patch", "red", "green", "blue", "spread, percent"}, {}};
  for (const auto& [rgb, spread] : measured) {
    table.rows.push_back({std::to_string(table.rows.size() + 1), fmt::format("{:.4f}", rgb[0]),
                          fmt::format("{:.4f}", rgb[1]), fmt::format("{:.4f}", rgb[2]),
                          fmt::format("{:.2f}", 100 * spread)});
    out.numbers["patches"].push_back({{"reflectance_rgb", Json(rgb)}, {"spread", spread}});
  }
  out.sections.push_back({"Patches", {}, std::move(table), {}});
  return out;
}

}  // namespace

std::string patches_left_out(const std::string& part) {
  return fmt::format(
      "the white patches were left out, as they were measured by the {} of before: measure them "
      "again with weft calibrate patches",
      part);
}

Result<CalibrateOutcome> calibrate_patches(const CalibratePatchesOptions& options,
                                           const JobContext& context) {
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  Result<SessionPlan> plan = plan_session({options.session, options.from, {}});
  if (!plan) return std::move(plan).error();
  const fs::path file = options.patches.empty()
                            ? absolute_folder(options.session).parent_path() / "patches.toml"
                            : options.patches;
  Result<std::vector<WhitePatch>> patches = read_patches(file, plan->size);
  if (!patches) return std::move(patches).error();
  if (!std::holds_alternative<NearLights>(*plan->calibration.lights)) {
    return bad_patches(options.session.string(), "the calibration's lights are distant");
  }
  plan->calibration.patches.clear();  // those of before say nothing of these
  const Result<LoadedSession> loaded = load_session(*plan, context);
  if (!loaded) return loaded.error();

  const fs::path from = options.from.empty() ? options.session / "calibration" : options.from;
  Calibration change = plan->calibration;
  change.patches = std::move(*patches);
  const Result<std::vector<MeasuredPatch>> measured =
      measure_patches(change, loaded->photographs, file, options.paper_delta.value_or(reported_delta(from)));
  if (!measured) return measured.error();
  for (std::size_t p = 0; p < measured->size(); ++p)
    change.patches[p].reflectance_rgb = (*measured)[p].reflectance_rgb;

  CalibrateOutcome outcome;
  outcome.report = report_of(*measured, change.subject.rig);
  Calibration parts;
  parts.subject = change.subject;
  parts.subject.measured.clear();
  parts.lights = change.lights;
  parts.light_covariance = change.light_covariance;
  parts.patches = change.patches;
  Result<Calibration> written =
      derive_calibration(from, std::move(parts), options.output, report_files(outcome.report));
  if (!written) return std::move(written).error();
  outcome.folder = options.output;
  outcome.calibration = std::move(*written);
  return outcome;
}

}  // namespace weft::app
