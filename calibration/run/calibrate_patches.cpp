// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "calibration/run/check_result.h"
#include "calibration/run/described.h"
#include "calibration/run/rig_evidence.h"
#include "calibration/run/sheet_files.h"
#include "calibration/run/tag_cards.h"
#include "core/base/files.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"
#include "solve/conditions/drift.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;
constexpr double kMostSpread = 0.1;

Error bad_patches(const std::string& where, std::string why) {
  return {ErrorKind::kBadData, "white patches cannot be used", where, std::move(why),
          "give each [[patch]] a polygon_px of three corners or more inside the frame"};
}

/// A [[patch]] of patches.toml.
struct PatchEntry {
  Json polygon_px;
  std::optional<double> height_mm, delta;
};

void describe(Fields& fields, PatchEntry& patch) {
  fields.value({"polygon_px", "Three corners or more, [[x, y], ...]"}, patch.polygon_px);
  fields.require(rows_of(patch.polygon_px, 2).value_or(std::vector<std::vector<double>>()).size() >= 3,
                 "polygon_px", "must be three corners or more, [[x, y], ...]");
  fields.value({"height_mm", "Where it lies; default as high as the tags", {-1000, 1000}}, patch.height_mm);
  fields.value({"delta", "How it falls off; default as the paper of the lights", {-0.5, 0.99}}, patch.delta);
}

struct PatchFile {
  std::vector<PatchEntry> patches;
};

void describe(Fields& fields, PatchFile& file) {
  fields.list({.name = "patch", .says = "Where each lies", .need = kMustSay}, file.patches);
}

/// `common` holds what a patch is that does not say otherwise.
Result<std::vector<WhitePatch>> read_patches(const fs::path& file, Size frame, const WhitePatch& common) {
  const Result<PatchFile> said = read_file<PatchFile>(file, kCalibrationPage);
  if (!said) return said.error();
  std::vector<WhitePatch> patches;
  for (const PatchEntry& entry : said->patches) {
    WhitePatch& patch = patches.emplace_back(common);
    patch.height_mm = entry.height_mm.value_or(*common.height_mm);
    patch.delta = entry.delta.value_or(common.delta);
    const auto corners = rows_of(entry.polygon_px, 2);
    for (const std::vector<double>& corner : *corners) {
      const double x = corner[0], y = corner[1];
      if (!(x >= 0 && x < frame.width && y >= 0 && y < frame.height)) {
        return bad_patches(fmt::format("{}: patch {}", file.string(), patches.size()),
                           "a corner lies outside the frame");
      }
      patch.polygon_px.push_back({x, y});
    }
  }
  return patches;
}

/// The white beside the tags, where the rig has such cards.
Result<std::vector<WhitePatch>> white_of_cards(const Calibration& calibration, const WhitePatch& common) {
  std::vector<WhitePatch> patches = patches_of_cards(calibration, common);
  if (!patches.empty()) return patches;
  return Error{ErrorKind::kBadData, "white patches cannot be used", "tags.toml",
               "no card with its white lies whole in the frame",
               "lay the white of each card towards the middle of the picture, and calibrate the camera with "
               "them in sight"};
}

struct MeasuredPatch {
  std::array<double, 3> reflectance_rgb = {};
  double spread = 0;  ///< of the reflectance from LED to LED, as a share of it
};

/// Means over the LEDs by whose light all of the patch can be read.
Result<MeasuredPatch> measure_patch(const solve::Photographs& photographs, const WhitePatch& patch,
                                    const LightField& field, const std::string& where) {
  MeasuredPatch measured;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  int leds = 0;
  for (const std::optional<solver::PatchLight>& light : solve::read_patch(photographs, patch, field)) {
    if (!light || light->unusable > 0) continue;
    ++leds;
    for (std::size_t c = 0; c < 3; ++c)
      measured.reflectance_rgb[c] += light->reading_rgb[c] / light->predicted_rgb[c];
    least = std::min(least, light->factor());
    most = std::max(most, light->factor());
  }
  if (leds < 3) return bad_patches(where, "fewer than three LEDs light it, or it is saturated");
  for (double& r : measured.reflectance_rgb) r /= leds;
  measured.spread = (most - least) / measured.reflectance_rgb[1];
  if (measured.spread <= kMostSpread) return measured;
  return bad_patches(where,
                     fmt::format("its reflectance differs by {:.1f} percent from LED to LED: it is not "
                                 "white, flat and in the light",
                                 100 * measured.spread));
}

Result<std::vector<MeasuredPatch>> measure_patches(const solve::Photographs& photographs,
                                                   std::span<const WhitePatch> patches,
                                                   const fs::path& file) {
  std::vector<MeasuredPatch> measured;
  for (const WhitePatch& patch : patches) {
    const Result<LightField> field =
        LightField::make(photographs.field->lights(), photographs.camera, photographs.size, *patch.height_mm);
    if (!field) return field.error();
    Result<MeasuredPatch> one = measure_patch(
        photographs, patch, *field, fmt::format("{}: patch {}", file.string(), measured.size() + 1));
    if (!one) return std::move(one).error();
    measured.push_back(*one);
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

void describe(Fields& fields, CalibratePatchesOptions& o) {
  fields.value({.name = "session",
                .says = "A scan of the table while the calibration is fresh",
                .need = kMustSay,
                .path = PathTo::kSession,
                .option = ""},
               o.session);
  fields.value(
      {.name = "patches",
       .says = "patches.toml: where they lie; default beside the session, else the white of the rig's "
               "cards (weft target tags)",
       .path = PathTo::kFile},
      o.patches);
  fields.value({.name = "from",
                .says = "The calibration to add them to; default the session's own",
                .path = PathTo::kFolder},
               o.from);
  describe_paper_delta(fields, o.paper_delta);
  describe_new_calibration(fields, o.output);
}

Result<CalibrateOutcome> calibrate_patches(const CalibratePatchesOptions& options,
                                           const JobContext& context) {
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  Result<solve::SolvePlan> plan = solve::plan_session({options.session, options.from, {}});
  if (!plan) return std::move(plan).error();
  const fs::path file = options.patches.empty()
                            ? absolute_folder(options.session).parent_path() / "patches.toml"
                            : options.patches;
  const fs::path from = options.from.empty() ? options.session / "calibration" : options.from;
  const WhitePatch common = {.delta = options.paper_delta.value_or(reported_delta(from)),
                             .height_mm = tag_height_mm(plan->calibration.fiducials)};
  const bool is_by_cards = options.patches.empty() && !is_there(file) && has_cards(options.session);
  Result<std::vector<WhitePatch>> patches =
      is_by_cards ? white_of_cards(plan->calibration, common) : read_patches(file, plan->size, common);
  if (!patches) return std::move(patches).error();
  if (!std::holds_alternative<NearLights>(*plan->calibration.lights)) {
    return bad_patches(options.session.string(), "the calibration's lights are distant");
  }
  plan->calibration.patches.clear();  // those of before say nothing of these
  const Result<solve::Photographs> loaded = solve::load_photographs(*plan, context);
  if (!loaded) return loaded.error();

  const Result<std::vector<MeasuredPatch>> measured = measure_patches(*loaded, *patches, file);
  if (!measured) return measured.error();
  Calibration change = plan->calibration;
  change.patches = std::move(*patches);
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
  parts.points = change.points;
  Result<Calibration> written =
      derive_calibration(from, std::move(parts), options.output, report_files(outcome.report));
  if (!written) return std::move(written).error();
  outcome.folder = options.output;
  outcome.calibration = std::move(*written);
  return outcome;
}

}  // namespace weft::calibration
