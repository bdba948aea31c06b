// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "calibration/run/check_result.h"
#include "calibration/run/described.h"
#include "calibration/run/history.h"
#include "calibration/run/movement_words.h"
#include "calibration/run/rig_evidence.h"
#include "calibration/run/sheet_captures.h"
#include "calibration/run/sheet_evidence.h"
#include "calibration/run/sheet_files.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/field_check.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

struct CheckedSheet {
  std::string name;
  SheetCheck check;
  int columns = 0, rows = 0;
  std::optional<double> drift;  ///< of the LED that changed most, relative
  bool was_fitted = false;      ///< lights were fitted to this session
  std::vector<std::string> warnings;
};

Result<std::vector<fs::path>> sessions_in(const fs::path& input) {
  if (is_there(input / "session.json")) return std::vector{input};
  std::vector<fs::path> sessions;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(input, failed)) {
    if (is_there(entry.path() / "session.json")) sessions.push_back(entry.path());
  }
  if (sessions.empty()) {
    return Error{ErrorKind::kNoInput, "there is no session to check with", input.string(),
                 "it is no session and has none in it",
                 "scan a sheet of white paper with tags that lights were not fitted to"};
  }
  std::sort(sessions.begin(), sessions.end());
  return sessions;
}

/// A [[plane]] of check.toml: a sheet on a wedge.
struct KnownPlane {
  std::string session;
  double tilt_deg = 0, azimuth_deg = 0;
};

void describe(Fields& fields, KnownPlane& plane) {
  fields.value({.name = "session", .says = "Folder beside this file", .need = kMustSay}, plane.session);
  fields.value({"tilt_deg", "Of the sheet, degrees", {0, 60}, kMustSay}, plane.tilt_deg);
  fields.value({"azimuth_deg", "Towards which its normal leans, degrees", {-360, 360}, kMustSay},
               plane.azimuth_deg);
}

struct CheckFile {
  std::vector<KnownPlane> planes;
};

void describe(Fields& fields, CheckFile& file) {
  fields.list({.name = "plane", .says = "Sheets on wedges", .need = kMustSay}, file.planes);
}

/// Normals of sheets on wedges, by session.
Result<std::map<std::string, Vec3>> known_planes(const fs::path& input) {
  std::map<std::string, Vec3> planes;
  const fs::path file = in_or_beside(input, "check.toml");
  if (!is_there(file)) return planes;
  const Result<CheckFile> said = read_file<CheckFile>(file, kCalibrationPage);
  if (!said) return said.error();
  for (const KnownPlane& plane : said->planes) {
    if (plane.session.empty() || !is_there(file.parent_path() / plane.session)) {
      return unusable_description(fmt::format("{}: plane {}: session", file.string(), planes.size() + 1),
                                  kCalibrationPage, "must name a session beside this file");
    }
    const double t = radians(plane.tilt_deg), a = radians(plane.azimuth_deg);
    planes[plane.session] = {std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)};
  }
  return planes;
}

std::optional<double> drift_in(const ConditionFacts& conditions) {
  if (conditions.drift.empty()) return std::nullopt;
  double most = 0;
  for (const ConditionedLed& led : conditions.drift) most = std::max(most, std::abs(led.factor - 1));
  return most;
}

Result<CheckedSheet> check_session(const CalibrateCheckOptions& options, const fs::path& session,
                                   const TaggedSheet& sheet, const std::map<std::string, Vec3>& planes,
                                   const JobContext& context, Calibration& calibration,
                                   std::string& taken_at) {
  Result<solve::SolvePlan> plan = solve::plan_session({session, options.from, {}});
  if (!plan) return plan.error();
  if (!calibration.id.empty() && plan->calibration.id != calibration.id) {
    return Error{ErrorKind::kBadData, "the sessions were taken with different calibrations", session.string(),
                 fmt::format("it has {:.12}, those before have {:.12}", plan->calibration.id, calibration.id),
                 "name the calibration to check with --from, or check each session alone"};
  }
  plan->calibration.patches.clear();  // the sheet may cover them: drift is what the repeat shot says
  const Result<solve::Photographs> loaded = solve::load_photographs(*plan, context);
  if (!loaded) return loaded.error();
  calibration = plan->calibration;
  if (!std::holds_alternative<NearLights>(*calibration.lights)) {
    return Error{ErrorKind::kBadData, "the calibration cannot be checked", session.string(),
                 "its lights are distant", "calibrate the rig's lights first"};
  }
  Result<SheetEvidence> evidence =
      sheet_evidence(calibration, *loaded, sheet, options.square_px, session.string(), context);
  if (!evidence) return std::move(evidence).error();
  const auto plane = planes.find(session.filename().string());
  if (plane != planes.end()) evidence->known_normal = plane->second;
  const fs::path folder = options.from.empty() ? session / "calibration" : options.from;
  evidence->paper_delta = options.paper_delta.value_or(sheet.delta.value_or(reported_delta(folder)));
  const Result<std::vector<std::string>> shots = lit_sha256(plan->session);
  if (!shots) return shots.error();
  const std::set<std::string> fitted = fitted_sha256(folder);
  CheckedSheet checked;
  checked.name = session.filename().string();
  checked.was_fitted = std::any_of(shots->begin(), shots->end(),
                                   [&](const std::string& sha256) { return fitted.contains(sha256); });
  checked.check = check_sheet(*calibration.camera, std::get<NearLights>(*calibration.lights), *evidence);
  checked.columns = evidence->columns;
  checked.rows = evidence->rows;
  checked.drift = drift_in(loaded->conditions.facts);
  checked.warnings = loaded->conditions.warnings;
  if (const std::string& time = plan->lit.front().time;
      seconds_of_iso_time(time) > seconds_of_iso_time(taken_at))
    taken_at = time;
  return checked;
}

/// What a sheet says against the calibration.
std::vector<Verdict> verdicts_of(const CheckedSheet& sheet, const CheckLimits& limits) {
  constexpr const char* kRemedy = "calibrate the lights again, and camera and response before them";
  std::vector<Verdict> verdicts;
  const SheetCheck& check = sheet.check;
  if (sheet.was_fitted) {
    verdicts.push_back(
        {"FITTED_TO_IT",
         fmt::format("{} is one that the lights were fitted to: it comes out flat whatever they are",
                     sheet.name),
         "scan another sheet, or turn this one"});
  }
  if (check.squares == 0) {
    verdicts.push_back({"NO_NORMALS",
                        fmt::format("{}: fewer than three LEDs light any square of the sheet", sheet.name),
                        "see whether the LEDs light and the frames are neither dark nor saturated"});
    return verdicts;
  }
  if (check.slope_gain) {
    if (std::abs(*check.slope_gain - 1) > limits.slope_gain) {
      verdicts.push_back(
          {"SLOPE_GAIN",
           fmt::format("{}: slopes come out {:.4f} ± {:.4f} times as steep as they are, and 1 ± {} is "
                       "allowed",
                       sheet.name, *check.slope_gain, check.slope_gain_sigma, limits.slope_gain),
           kRemedy});
    }
    const double most_rms_deg = std::hypot(limits.tilted_rms_deg, check.normal_sigma_deg);
    if (check.rms_deg > most_rms_deg || check.pattern_rms_deg > limits.tilted_rms_deg) {
      verdicts.push_back(
          {"SLOPES_OFF",
           fmt::format("{}: normals of a tilted sheet are {:.3f} degrees rms off ({:.3f} about their mean), "
                       "and {:.3f} ({}) are allowed",
                       sheet.name, check.rms_deg, check.pattern_rms_deg, most_rms_deg, limits.tilted_rms_deg),
           kRemedy});
    }
  } else if (check.rms_deg > limits.flat_rms_deg) {
    verdicts.push_back(
        {"NOT_FLAT",
         fmt::format("{}: a flat sheet is {:.3f} degrees rms from flat ({:.3f} about its mean), and {} "
                     "are allowed",
                     sheet.name, check.rms_deg, check.pattern_rms_deg, limits.flat_rms_deg),
         kRemedy});
  }
  if (sheet.drift && *sheet.drift > limits.drift) {
    verdicts.push_back({"DRIFT",
                        fmt::format("{}: a LED changed by {:.2f} percent during the scan, and {} are allowed",
                                    sheet.name, 100 * *sheet.drift, 100 * limits.drift),
                        "let the LEDs warm up, or give them a steadier supply"});
  }
  return verdicts;
}

std::string number(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}

std::vector<std::string> row_of(const CheckedSheet& sheet) {
  const SheetCheck& c = sheet.check;
  return {sheet.name,
          number(c.tilt_deg, 2),
          std::to_string(c.squares),
          number(c.rms_deg, 3),
          number(c.pattern_rms_deg, 3),
          number(c.worst_deg, 3),
          c.slope_gain ? fmt::format("{:.4f} ± {:.4f}", *c.slope_gain, c.slope_gain_sigma) : "",
          sheet.drift ? number(100 * *sheet.drift, 2) : ""};
}

Json numbers_of(const CheckedSheet& sheet) {
  const SheetCheck& c = sheet.check;
  Json json = {{"session", sheet.name},
               {"tilt_deg", c.tilt_deg},
               {"squares", c.squares},
               {"rms_deg", c.rms_deg},
               {"worst_deg", c.worst_deg},
               {"pattern_rms_deg", c.pattern_rms_deg},
               {"reflectance_rgb", Json(c.reflectance_rgb)}};
  if (c.slope_gain) {
    json["slope_gain"] = *c.slope_gain;
    json["slope_gain_sigma"] = c.slope_gain_sigma;
  }
  if (sheet.drift) json["drift"] = *sheet.drift;
  return json;
}

/// Something that sheets are checked for.
struct Aspect {
  const char* name;
  std::string found;     ///< the worst of all sheets; empty: no sheet tells
  const char* no_sheet;  ///< said then
};

std::array<Aspect, 3> aspects_of(const std::vector<CheckedSheet>& sheets) {
  std::optional<double> flat_rms_deg, slopes_off, drift;
  const auto keep_worst = [](std::optional<double>& worst, double value) {
    worst = std::max(worst.value_or(0), value);
  };
  for (const CheckedSheet& sheet : sheets) {
    const SheetCheck& c = sheet.check;
    if (c.slope_gain) keep_worst(slopes_off, std::abs(*c.slope_gain - 1));
    if (!c.slope_gain && c.squares > 0) keep_worst(flat_rms_deg, c.rms_deg);
    if (sheet.drift) keep_worst(drift, *sheet.drift);
  }
  return {
      {{"flatness", flat_rms_deg ? fmt::format(", flat ones within {:.3f} degrees rms", *flat_rms_deg) : "",
        "No sheet lay flat: whether a level surface comes out level was not checked."},
       {"slopes", slopes_off ? fmt::format(", slopes within {:.2f} percent", 100 * *slopes_off) : "",
        "No sheet was tilted: how steep slopes come out was not checked."},
       {"drift", drift ? fmt::format(", LEDs steady to {:.2f} percent", 100 * *drift) : "",
        "No LED was lit once more: whether LEDs drift was not checked."}}};
}

CalibrationReport sheets_report(const std::vector<CheckedSheet>& sheets, const Calibration& calibration,
                                const CalibrateCheckOptions& options) {
  CalibrationReport report;
  report.part = "check";
  report.title = fmt::format("Check of the calibration of {}", calibration.subject.rig);
  report::Section section = {"Sheets", {}, report::Table{}, {}};
  section.paragraphs = {
      fmt::format("Each sheet was solved in squares of {} pixels, at the point that its tags give. A flat "
                  "sheet may be {} degrees rms from flat, a tilted one {} off, slopes 1 ± {} times as steep "
                  "as they are, LEDs may drift by {} percent.",
                  options.square_px, options.limits.flat_rms_deg, options.limits.tilted_rms_deg,
                  options.limits.slope_gain, 100 * options.limits.drift)};
  section.is_answer = true;
  section.table->header = {"sheet",          "tilt, degrees", "squares",    "rms, degrees",
                           "about the mean", "worst",         "slope gain", "drift, percent"};
  for (const CheckedSheet& sheet : sheets) {
    section.table->rows.push_back(row_of(sheet));
    section.figures.push_back(
        {fmt::format("Angle between {} as it is solved and as it lies", sheet.name),
         report::FrameMap{sheet.columns, sheet.rows, sheet.check.error_deg, "degrees"}});
    report.numbers["sheets"].push_back(numbers_of(sheet));
    for (Verdict& verdict : verdicts_of(sheet, options.limits)) report.verdicts.push_back(std::move(verdict));
  }
  std::string found = fmt::format("{} sheet{}", sheets.size(), sheets.size() == 1 ? "" : "s");
  std::vector<std::string> not_checked;
  for (const Aspect& aspect : aspects_of(sheets)) {
    found += aspect.found;
    if (!aspect.found.empty()) continue;
    not_checked.emplace_back(aspect.name);
    section.paragraphs.emplace_back(aspect.no_sheet);
  }
  report.numbers["not_checked"] = not_checked;
  report.sections.push_back(std::move(section));
  report.summary = fmt::format(
      "{}{}: {}", report.verdicts.empty() ? "Accepted" : "Refused",
      not_checked.empty() ? "" : fmt::format(", with {} not checked", fmt::join(not_checked, " and ")),
      found);
  return report;
}

/// What to say where nothing contradicts the calibration and yet not all is well; else empty.
std::string doubt_of(const Movement& movement) {
  if (movement.chi_square_after < kDoubtfulFrom || movement.chi_square_after > kUnexplainedFrom) return "";
  return fmt::format(
      "What is seen is explained worse than usual: chi-square is {:.1f} for each observation, and about 1 "
      "where all is well; look whether a patch is dirty, a tag lies loose or a lamp is on",
      movement.chi_square_after);
}

CalibrationReport rig_report(const RigCheck& rig, const std::string& session) {
  CalibrationReport report;
  const Movement& movement = rig.movement;
  report.part = "check";
  report.title = fmt::format("Has {} moved?", rig.calibration.subject.rig);
  report::Section section = {"What the session shows", {}, {}, {}};
  section.paragraphs.push_back(fmt::format(
      "{} corners of tags, {} fixed points and {} readings were compared with what the calibration predicts: "
      "chi-square {:.2f} each before, {:.2f} with what was found.",
      movement.corners, movement.points, movement.readings, movement.chi_square_before,
      movement.chi_square_after));
  const bool sees_place = movement.corners > 0 || movement.points > 0;
  if (!sees_place) {
    section.paragraphs.push_back(
        "No tag and no fixed point of the calibration was in sight: whether camera and table moved to each "
        "other was not checked.");
  }
  if (movement.readings == 0) {
    section.paragraphs.push_back(
        "No white patch and no sheet was read: LEDs were not checked, and a moved camera cannot be told from "
        "a moved table.");
  }
  report.numbers = {{"session", session},
                    {"corners", movement.corners},
                    {"points", movement.points},
                    {"readings", movement.readings},
                    {"chi_square_before", movement.chi_square_before},
                    {"chi_square_after", movement.chi_square_after},
                    {"cost_mean_deg", rig.cost.mean_deg},
                    {"cost_worst_deg", rig.cost.worst_deg},
                    {"changes", Json::array()}};
  for (const RigChange& change : movement.changes) {
    Verdict verdict = verdict_of(change);
    section.paragraphs.push_back(verdict.text + ".");
    report.numbers["changes"].push_back(json_of(change));
    if (matters(rig.cost)) report.verdicts.push_back(std::move(verdict));
  }
  if (const std::string doubt = doubt_of(movement); !doubt.empty()) section.paragraphs.push_back(doubt + ".");
  if (movement.chi_square_after > kUnexplainedFrom) {
    report.verdicts.push_back(
        {"UNEXPLAINED",
         fmt::format(
             "What is seen contradicts the calibration (chi-square {:.1f} for each observation), and no "
             "change of camera, table or LEDs explains it",
             movement.chi_square_after),
         "see whether a patch is covered or a tag was laid elsewhere, else calibrate again"});
  }
  if (!movement.changes.empty() && !matters(rig.cost)) {
    report.summary = fmt::format(
        "The rig is where it was calibrated, but for what changes no map: {:.3f} degrees at worst",
        rig.cost.worst_deg);
  } else if (!movement.changes.empty()) {
    report.summary = fmt::format(
        "The rig has changed; scanning on would cost {:.2f} degrees in the mean and {:.2f} at worst",
        rig.cost.mean_deg, rig.cost.worst_deg);
  } else {
    report.summary = !report.verdicts.empty() ? "The rig is not as it was calibrated, and nothing says why"
                     : movement.readings == 0
                         ? "Camera and table are as they were calibrated; LEDs were not checked"
                     : !sees_place ? "LEDs are as they were calibrated; camera against table was not checked"
                                   : "Nothing has moved since the rig was calibrated";
  }
  report.sections.push_back(std::move(section));
  return report;
}

struct Look {
  RigCheck rig;
  std::vector<std::string> warnings;
  std::string taken_at;
};

/// What the sheet reads in one more session.
Result<void> add_sheet(const solve::Photographs& loaded, Size size, const fs::path& session,
                       const Calibration& calibration, const TaggedSheet& sheet, const JobContext& context,
                       RigEvidence& evidence, std::vector<Pose>& sheets) {
  // Every reading is weighed against every other one: about 10 squares by 7, whatever the frame.
  const int side = std::max(std::max(size.width, size.height) / 10 & ~1, 16);
  const auto seen = sheet_evidence(calibration, loaded, sheet, side, session.string(), context);
  if (!seen) return seen.error();
  sheets.push_back(seen->rig_from_sheet);
  for (LitPlace& place : places_of(*seen, *calibration.camera)) evidence.places.push_back(std::move(place));
  return {};
}

Result<Look> look(const CheckRigOptions& options, const JobContext& context) {
  const Result<std::vector<fs::path>> sessions = sessions_in(options.session);
  if (!sessions) return sessions.error();
  const fs::path& first = sessions->front();
  const Result<solve::SolvePlan> plan = solve::plan_session({first, options.from, {}});
  if (!plan) return plan.error();
  const Result<solve::Photographs> loaded = solve::load_photographs(*plan, context);
  if (!loaded) return loaded.error();
  const fs::path folder = options.from.empty() ? first / "calibration" : options.from;
  Look out = {{{}, {}, plan->calibration, folder, {}}, loaded->conditions.warnings, plan->lit.front().time};
  const Calibration& calibration = out.rig.calibration;
  const Result<RigSightings> sightings = sightings_in(calibration, *loaded);
  if (!sightings) return sightings.error();
  RigEvidence evidence = evidence_of(calibration, *sightings);
  MovementOptions settings = options.movement;
  double delta = reported_delta(folder);
  const bool is_set = first != options.session;
  if (is_set || !options.sheet.empty()) {
    const Result<TaggedSheet> sheet =
        read_sheet_file(options.sheet.empty() ? options.session / "sheet.toml" : options.sheet);
    if (!sheet) return sheet.error();
    delta = sheet->delta.value_or(delta);
    Result<void> added =
        add_sheet(*loaded, plan->size, first, calibration, *sheet, context, evidence, out.rig.sheets);
    for (const fs::path& pose : std::span(*sessions).subspan(1)) {
      if (!added) break;
      const Result<solve::SolvePlan> another = solve::plan_session({pose, folder, {}});
      if (!another) return another.error();
      const Result<solve::Photographs> read = solve::load_photographs(*another, context);
      if (!read) return read.error();
      added = add_sheet(*read, another->size, pose, calibration, *sheet, context, evidence, out.rig.sheets);
    }
    if (!added) return std::move(added).error();
  }
  settings.paper_delta = options.paper_delta.value_or(delta);
  Result<Movement> movement = find_movement(calibration, evidence, settings);
  if (!movement) {
    Error error = movement.error();
    error.where = options.session.string();
    return error;
  }
  out.rig.movement = std::move(*movement);
  out.rig.cost = cost_of(*calibration.camera, std::get<NearLights>(*calibration.lights),
                         out.rig.movement.camera, out.rig.movement.lights);
  return out;
}

}  // namespace

void describe(Fields& fields, CheckLimits& l) {
  fields.value({"flat_limit_deg", "Of flat sheets, rms degrees", kAboveZero}, l.flat_rms_deg);
  fields.value({"tilted_limit_deg", "Of tilted sheets, rms degrees", kAboveZero}, l.tilted_rms_deg);
  fields.value({"gain_limit", "Of the slope gain, off 1", kAboveZero}, l.slope_gain);
  fields.value({"drift_limit", "Of a LED that is lit once more, relative", kAboveZero}, l.drift);
}

void describe(Fields& fields, CalibrateCheckOptions& o) {
  fields.value({.name = "input",
                .says = "Session of a sheet, or a folder of sessions",
                .path = PathTo::kFolder,
                .option = ""},
               o.input);
  fields.value(
      {.name = "session",
       .says = "Any scan that shows tags, white patches or the sheet; or a folder of scans of the sheet in "
               "several poses (weft capture moved)",
       .path = PathTo::kSessionOrSet},
      o.session);
  fields.exclude("session", "input");
  fields.need_one({"input", "session"});
  fields.value({.name = "from",
                .says = "The calibration in question; default each session's own",
                .path = PathTo::kFolder},
               o.from);
  fields.value(
      {.name = "sheet",
       .says = "sheet.toml of the sheet in the pictures; default that beside them, with --session no sheet",
       .path = PathTo::kFile},
      o.sheet);
  describe_paper_delta(fields, o.paper_delta);
  fields.value({.name = "output",
                .says = "Folder for result and report; default nothing is written",
                .path = PathTo::kNewFolder,
                .option = "-o,--output"},
               o.output);
  fields.value({.name = "square_px",
                .says = "Side of the squares that are compared, pixels",
                .range = {8, 512},
                .option = "--square-px"},
               o.square_px);
  fields.require(o.square_px % 2 == 0, "square_px", "must be even");
  describe(fields, o.limits);
}

Result<CalibrateOutcome> calibrate_check(const CalibrateCheckOptions& options, const JobContext& context) {
  if (Result<void> fits = check_fields(options); !fits) return std::move(fits).error();
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  const Result<std::vector<fs::path>> sessions = sessions_in(options.input);
  if (!sessions) return sessions.error();
  const Result<TaggedSheet> sheet =
      read_sheet_file(options.sheet.empty() ? in_or_beside(options.input, "sheet.toml") : options.sheet);
  if (!sheet) return sheet.error();
  const auto planes = known_planes(options.input);
  if (!planes) return planes.error();
  std::vector<CheckedSheet> sheets;
  CalibrateOutcome outcome;
  std::string taken_at;
  for (const fs::path& session : *sessions) {
    if (context.stop.stop_requested()) return interrupted();
    Result<CheckedSheet> checked =
        check_session(options, session, *sheet, *planes, context, outcome.calibration, taken_at);
    if (!checked) return std::move(checked).error();
    for (const std::string& warning : checked->warnings)
      outcome.warnings.push_back(fmt::format("{}: {}", checked->name, warning));
    sheets.push_back(std::move(*checked));
  }
  outcome.report = sheets_report(sheets, outcome.calibration, options);
  outcome.folder = options.output;
  const Result<void> written =
      write_check_result(options.output, "sheets", outcome.calibration, outcome.report, taken_at);
  if (!written) return written.error();
  return outcome;
}

Result<RigCheck> look_at_rig(const CheckRigOptions& options, const JobContext& context) {
  Result<Look> seen = look(options, context);
  if (!seen) return std::move(seen).error();
  return std::move(seen->rig);
}

Result<CalibrateOutcome> calibrate_check_rig(const CheckRigOptions& options, const JobContext& context) {
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  Result<Look> seen = look(options, context);
  if (!seen) return std::move(seen).error();
  CalibrateOutcome outcome;
  outcome.report = rig_report(seen->rig, options.session.string());
  outcome.calibration = std::move(seen->rig.calibration);
  outcome.warnings = std::move(seen->warnings);
  if (std::string doubt = doubt_of(seen->rig.movement); !doubt.empty())
    outcome.warnings.push_back(std::move(doubt));
  outcome.folder = options.output;
  const Result<void> written =
      write_check_result(options.output, "session", outcome.calibration, outcome.report, seen->taken_at);
  if (!written) return written.error();
  return outcome;
}

}  // namespace weft::calibration
