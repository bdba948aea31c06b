// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/update.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>

#include "calibration/lights/sheet.h"
#include "calibration/run/check.h"
#include "calibration/run/described.h"
#include "calibration/run/movement_words.h"
#include "calibration/run/rig_evidence.h"
#include "core/base/files.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

bool moves_body(ChangeKind kind) {
  return kind == ChangeKind::kCamera || kind == ChangeKind::kTable;
}

/// The part of an old covariance that still holds, with what was fitted in its place.
std::optional<ParameterCovariance> merged(const std::optional<ParameterCovariance>& old,
                                          const ParameterCovariance& fitted) {
  if (!old || fitted.parameters.empty()) return old;
  ParameterCovariance out = *old;
  const std::size_t n = out.parameters.size();
  std::vector<std::size_t> place;
  for (const std::string& name : fitted.parameters) {
    const auto found = std::find(out.parameters.begin(), out.parameters.end(), name);
    place.push_back(static_cast<std::size_t>(found - out.parameters.begin()));
  }
  for (const std::size_t p : place) {
    for (std::size_t i = 0; p < n && i < n; ++i) out.matrix[p * n + i] = out.matrix[i * n + p] = 0;
  }
  for (std::size_t a = 0; a < place.size(); ++a) {
    for (std::size_t b = 0; b < place.size(); ++b) {
      if (place[a] < n && place[b] < n)
        out.matrix[place[a] * n + place[b]] = fitted.matrix[a * place.size() + b];
    }
  }
  return out;
}

/// The covariance under the names that LEDs have once they are exchanged: what is known of a LED stays with
/// it.
std::optional<ParameterCovariance> renamed(std::optional<ParameterCovariance> covariance,
                                           const std::vector<RigChange>& changes) {
  if (!covariance) return covariance;
  for (std::string& name : covariance->parameters) {
    int led = 0;
    if (!name.starts_with("led")) continue;
    const auto [rest, failed] = std::from_chars(name.data() + 3, name.data() + name.size(), led);
    if (failed != std::errc()) continue;
    for (const RigChange& change : changes) {
      if (change.kind != ChangeKind::kLedsSwapped) continue;
      led = led == change.led ? change.other_led : led == change.other_led ? change.led : led;
    }
    name = fmt::format("led{:02}{}", led, std::string_view(rest));
  }
  return covariance;
}

/// The first change that something else explains as well: each would be put right in another way.
const RigChange* ambiguous(const Movement& movement) {
  const auto found = std::find_if(movement.changes.begin(), movement.changes.end(),
                                  [](const RigChange& change) { return !change.alternatives.empty(); });
  return found == movement.changes.end() ? nullptr : &*found;
}

Error refused(const CalibrateUpdateOptions& options, std::string what, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, std::move(what), options.session.string(), std::move(why), std::move(remedy)};
}

/// The parts that have changed.
Calibration change_of(const RigCheck& rig) {
  const Calibration& before = rig.calibration;
  const std::vector<RigChange>& changes = rig.movement.changes;
  const bool body =
      std::any_of(changes.begin(), changes.end(), [](const RigChange& c) { return moves_body(c.kind); });
  const bool lights = std::any_of(changes.begin(), changes.end(),
                                  [](const RigChange& c) { return c.kind != ChangeKind::kCamera; });
  Calibration change;
  change.subject = before.subject;
  change.subject.measured.clear();
  if (body) {
    change.camera = rig.movement.camera;
    change.fiducials = before.fiducials;
    change.spread = before.spread;
    change.lateral = before.lateral;
  }
  if (lights || (body && !(before.patches.empty() && before.points.empty()))) {
    change.lights = rig.movement.lights;
    change.light_covariance = renamed(merged(before.light_covariance, rig.movement.covariance), changes);
    const double height_mm = tag_height_mm(before.fiducials);
    for (const WhitePatch& patch : before.patches) {
      change.patches.push_back(
          relocated(patch, *before.camera, rig.movement.camera, patch.height_mm.value_or(height_mm)));
    }
    for (const FixedPoint& point : before.points)
      change.points.push_back(relocated(point, *before.camera, rig.movement.camera, height_mm));
  }
  return change;
}

CalibrationReport report_of(const RigCheck& rig, const fs::path& session) {
  CalibrationReport report;
  report.part = "update";
  report.title = fmt::format("Update of {}", rig.calibration.subject.rig);
  report::Section section = {"What was fitted again", {}, {}, {}};
  report.numbers = {{"session", session.string()},
                    {"updates", rig.calibration.id},
                    {"chi_square_before", rig.movement.chi_square_before},
                    {"chi_square_after", rig.movement.chi_square_after},
                    {"cost_mean_deg", rig.cost.mean_deg},
                    {"cost_worst_deg", rig.cost.worst_deg}};
  for (const Pose& sheet : rig.sheets) {
    report.numbers["sheets"].push_back(
        {{"tilt_deg", angle_deg(normal_of(sheet), {0, 0, 1})}, {"turn_deg", turn_deg(sheet)}});
  }
  for (const RigChange& change : rig.movement.changes) {
    section.paragraphs.push_back(verdict_of(change).text + ".");
    report.numbers["changes"].push_back(json_of(change));
  }
  section.paragraphs.push_back(
      "Everything else is as it was. The rig frame stays with the table: a table that moved is seen as a "
      "camera and "
      "LEDs that moved the other way.");
  report.sections.push_back(std::move(section));
  report.summary =
      fmt::format("Without this update scans would be off by {:.2f} degrees in the mean, {:.2f} at worst",
                  rig.cost.mean_deg, rig.cost.worst_deg);
  return report;
}

}  // namespace

void describe(Fields& fields, CalibrateUpdateOptions& o) {
  fields.value(
      {.name = "session",
       .says =
           "A scan after the move that shows tags, white patches or the sheet; or a folder of scans of the "
           "sheet in several poses (weft capture moved)",
       .need = kMustSay,
       .path = PathTo::kSessionOrSet,
       .option = ""},
      o.session);
  fields.value({.name = "from",
                .says = "The calibration in question; default each session's own",
                .path = PathTo::kFolder},
               o.from);
  fields.value({.name = "sheet",
                .says = "sheet.toml of the sheet in the pictures; default no sheet",
                .path = PathTo::kFile},
               o.sheet);
  describe_paper_delta(fields, o.paper_delta);
  describe_new_calibration(fields, o.output);
}

Result<CalibrateOutcome> calibrate_update(const CalibrateUpdateOptions& options, const JobContext& context) {
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  const Result<RigCheck> rig = look_at_rig(
      {options.session, options.from, options.sheet, {}, options.paper_delta, options.movement}, context);
  if (!rig) return rig.error();
  if (rig->movement.chi_square_after > kUnexplainedFrom) {
    return refused(
        options, "what has happened is not understood",
        fmt::format("with every change that was found, chi-square is still {:.1f} for each observation",
                    rig->movement.chi_square_after),
        "see whether a patch is covered or a tag was laid elsewhere, else calibrate again");
  }
  if (rig->movement.changes.empty()) {
    return refused(options, "there is nothing to update",
                   "tags, fixed points and readings are what the calibration predicts",
                   "go on with the calibration that there is");
  }
  if (const RigChange* change = ambiguous(rig->movement)) {
    return refused(options, "what has moved cannot be told", sentence(*change),
                   "show the sheet of white paper and name its sheet.toml, or calibrate again");
  }
  CalibrateOutcome outcome;
  outcome.report = report_of(*rig, options.session);
  Calibration change = change_of(*rig);
  if (change.camera && rig->calibration.camera_covariance)
    outcome.warnings.emplace_back(
        "the covariance of the camera was left out, for it says nothing of the move: weft calibrate camera "
        "measures it again");
  Result<Calibration> written =
      derive_calibration(rig->from, std::move(change), options.output, report_files(outcome.report));
  if (!written) return std::move(written).error();
  outcome.folder = options.output;
  outcome.calibration = std::move(*written);
  return outcome;
}

}  // namespace weft::calibration
