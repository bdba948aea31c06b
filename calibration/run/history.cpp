// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>

#include "calibration/run/accept.h"
#include "calibration/run/check_result.h"
#include "calibration/run/movement_words.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"
#include "report/plot_svg.h"
#include "solve/session/current.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kDay_s = 86400;

struct DatedCalibration {
  double time_s = 0;
  std::string name;
  Calibration calibration;
};

struct DatedCheck {
  double time_s = 0;
  std::string name;
  std::string date, of, calibration;
  bool passed = false;
  std::optional<double> mean_deg, worst_deg;  ///< cost of what a session shows
  bool read_leds = false;                     ///< and did not look at tags alone
  bool only_bodies_moved = false;             ///< camera or table, no LED
  std::string found;                          ///< what it said, in a few words
};

struct Records {
  std::vector<DatedCalibration> calibrations;
  std::vector<DatedCheck> checks;
  std::vector<std::string> warnings;
};

/// Folders at and below `root` that hold a file of this name, in order of their paths; those inside sessions
/// are copies and left out. kNoInput where `root` cannot be read.
Result<std::vector<fs::path>> folders_with(const fs::path& root, const char* name) {
  std::vector<fs::path> found;
  std::error_code failed;
  fs::recursive_directory_iterator walk(root, fs::directory_options::skip_permission_denied, failed), end;
  for (; !failed && walk != end; walk.increment(failed)) {
    std::error_code ignored;
    if (!walk->is_directory(ignored)) continue;
    if (is_there(walk->path() / name)) found.push_back(walk->path());
    if (is_there(walk->path() / "session.json")) walk.disable_recursion_pending();
  }
  if (failed) return cannot_read(root, failed.value());
  if (is_there(root / name)) found.push_back(root);
  std::sort(found.begin(), found.end());
  return found;
}

Result<void> read_calibrations(const fs::path& root, Records& records) {
  const Result<std::vector<fs::path>> folders = folders_with(root, "calibration.json");
  if (!folders) return folders.error();
  for (const fs::path& folder : *folders) {
    Result<Calibration> calibration = read_calibration(folder);
    if (!calibration) {
      records.warnings.push_back(calibration.error().message());
      continue;
    }
    const auto time_s = seconds_of_iso_time(calibration->subject.measured);
    if (!time_s) {
      records.warnings.push_back(
          fmt::format("{} says no time at which it was measured and was left out", folder.string()));
      continue;
    }
    records.calibrations.push_back({*time_s, fs::relative(folder, root).string(), std::move(*calibration)});
  }
  std::stable_sort(records.calibrations.begin(), records.calibrations.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return {};
}

Result<DatedCheck> read_check(const fs::path& folder) {
  const Result<CheckResult> said = read_check_result(folder);
  if (!said) return said.error();
  const Json& numbers = said->numbers;
  JsonFields costs(numbers, "numbers");
  DatedCheck check;
  check.date = said->date;
  check.of = said->of;
  check.calibration = said->calibration;
  check.time_s = seconds_of_iso_time(said->date).value_or(0);
  check.passed = said->passed;
  check.mean_deg = costs.optional_number("cost_mean_deg");
  check.worst_deg = costs.optional_number("cost_worst_deg");
  check.read_leds = check.of == "sheets" || costs.optional_number("readings").value_or(0) > 0;
  if (numbers.contains("changes") && numbers["changes"].is_array()) {
    check.only_bodies_moved = !numbers["changes"].empty();
    for (const Json& change : numbers["changes"]) {
      JsonFields one(change, "change");
      const std::string name = one.text("change");
      check.found += fmt::format("{}{}", check.found.empty() ? "" : ", ", name);
      check.only_bodies_moved = check.only_bodies_moved &&
                                (name == name_of(ChangeKind::kCamera) || name == name_of(ChangeKind::kTable));
      if (const auto led = one.optional_number("led")) check.found += fmt::format(" {:.0f}", *led);
    }
  }
  return check;
}

Result<void> read_checks(const fs::path& root, Records& records) {
  const Result<std::vector<fs::path>> folders = folders_with(root, kCheckResultFile);
  if (!folders) return folders.error();
  for (const fs::path& folder : *folders) {
    Result<DatedCheck> check = read_check(folder);
    if (!check) {
      records.warnings.push_back(check.error().message());
      continue;
    }
    check->name = fs::relative(folder, root).string();
    records.checks.push_back(std::move(*check));
  }
  std::stable_sort(records.checks.begin(), records.checks.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return {};
}

const NearLights* near_lights(const Calibration& calibration) {
  return calibration.lights ? std::get_if<NearLights>(&*calibration.lights) : nullptr;
}

/// Angle between the line of sight and straight down.
double camera_tilt_deg(const CameraModel& camera) {
  const auto& r = camera.camera_from_rig_rotation;
  return angle_deg({r[2][0], r[2][1], r[2][2]}, {0, 0, -1});
}

std::string number(std::optional<double> value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "";
}

/// A value of each LED over time, against that of the first calibration with lights.
template <typename Value>
std::string plot_of_leds(const std::vector<DatedCalibration>& all, const std::string& label,
                         const Value& value) {
  report::Plot plot = {.x_label = "days", .y_label = label};
  const NearLights* first = nullptr;
  for (const DatedCalibration& each : all) {
    const NearLights* lights = near_lights(each.calibration);
    if (lights == nullptr) continue;
    if (first == nullptr) first = lights;
    for (std::size_t k = 0; k < std::min(first->leds.size(), lights->leds.size()); ++k) {
      if (plot.series.size() <= k) {
        plot.series.push_back({.name = fmt::format("LED {}", k + 1), .joined = true});
      }
      plot.series[k].points.push_back(
          {(each.time_s - all.front().time_s) / kDay_s, value(lights->leds[k], first->leds[k])});
    }
  }
  return plot.series.empty() ? "" : report::plot_svg(plot);
}

std::string plot_of_camera(const std::vector<DatedCalibration>& all) {
  report::PlotSeries x = {.name = "x", .joined = true}, y = {.name = "y", .joined = true},
                     height = {.name = "height", .joined = true};
  std::optional<Vec3> first;
  for (const DatedCalibration& each : all) {
    if (!each.calibration.camera) continue;
    const Vec3 centre = centre_of(*each.calibration.camera);
    if (!first) first = centre;
    const Vec3 moved = centre - *first;
    const double days = (each.time_s - all.front().time_s) / kDay_s;
    x.points.push_back({days, moved.x});
    y.points.push_back({days, moved.y});
    height.points.push_back({days, moved.z});
  }
  if (!first) return "";
  return report::plot_svg(
      {.x_label = "days", .y_label = "mm against the first calibration", .series = {x, y, height}});
}

Json json_of(const Vec3& v) {
  return {v.x, v.y, v.z};
}

Json leds_json(const NearLights& lights) {
  Json leds = Json::array();
  for (const NearLight& led : lights.leds)
    leds.push_back(
        {{"led", leds.size() + 1}, {"position_mm", json_of(led.position_mm)}, {"flux_rgb", led.flux_rgb}});
  return leds;
}

report::Section calibrations_section(const std::vector<DatedCalibration>& all, Json& numbers) {
  report::Section section = {"Calibrations", {}, report::Table{}, {}};
  section.is_answer = true;
  section.table->header = {"measured",
                           "folder",
                           "id",
                           "LEDs",
                           "moved most, mm",
                           "brightness, percent",
                           "camera height, mm",
                           "camera tilt, degrees"};
  const NearLights* before = nullptr;
  for (const DatedCalibration& each : all) {
    const NearLights* lights = near_lights(each.calibration);
    const std::optional<CameraModel>& camera = each.calibration.camera;
    std::string moved, brightness;
    Json json = {
        {"measured", each.calibration.subject.measured}, {"folder", each.name}, {"id", each.calibration.id}};
    if (lights != nullptr && before != nullptr) {
      double most_mm = 0, flux = 0;
      const std::size_t n = std::min(lights->leds.size(), before->leds.size());
      for (std::size_t k = 0; k < n; ++k) {
        most_mm = std::max(most_mm, length(lights->leds[k].position_mm - before->leds[k].position_mm));
        flux += lights->leds[k].flux_rgb[1] / before->leds[k].flux_rgb[1] / static_cast<double>(n);
      }
      moved = number(most_mm, 2);
      brightness = number(100 * flux, 2);
      json["led_moved_most_mm"] = most_mm;
      json["brightness_factor"] = flux;
    }
    if (lights != nullptr) json["leds"] = leds_json(*lights);
    if (camera) {
      json["camera_mm"] = json_of(centre_of(*camera));
      json["camera_height_mm"] = centre_of(*camera).z;
      json["camera_tilt_deg"] = camera_tilt_deg(*camera);
    }
    section.table->rows.push_back(
        {each.calibration.subject.measured, each.name, each.calibration.id.substr(0, 12),
         lights == nullptr ? "" : std::to_string(lights->leds.size()), moved, brightness,
         camera ? number(centre_of(*camera).z, 2) : "", camera ? number(camera_tilt_deg(*camera), 3) : ""});
    if (lights != nullptr) before = lights;
    numbers["calibrations"].push_back(std::move(json));
  }
  const auto add = [&](const char* label, std::string svg) {
    if (!svg.empty()) section.figures.push_back({label, std::move(svg)});
  };
  add("Distance of each LED from where it was first",
      plot_of_leds(all, "mm", [](const NearLight& now, const NearLight& first) {
        return length(now.position_mm - first.position_mm);
      }));
  add("Flux of each LED over its first",
      plot_of_leds(all, "percent", [](const NearLight& now, const NearLight& first) {
        return 100 * now.flux_rgb[1] / first.flux_rgb[1];
      }));
  add("Where the camera is", plot_of_camera(all));
  return section;
}

report::Section checks_section(const std::vector<DatedCheck>& all, Json& numbers) {
  report::Section section = {"Checks", {}, report::Table{}, {}};
  section.is_answer = true;
  section.table->header = {"date", "folder", "of", "calibration", "passed", "found", "cost, degrees"};
  for (const DatedCheck& check : all) {
    section.table->rows.push_back({check.date, check.name, check.of, check.calibration.substr(0, 12),
                                   check.passed ? "yes" : "no", check.found,
                                   check.passed ? "" : number(check.mean_deg, 2)});
    numbers["checks"].push_back({{"date", check.date},
                                 {"folder", check.name},
                                 {"calibration", check.calibration},
                                 {"passed", check.passed},
                                 {"found", check.found}});
  }
  return section;
}

/// Whether a check that passed knows that what another one found was not so then: tags alone tell nothing of
/// LEDs.
bool clears(const DatedCheck& passed, const DatedCheck& failed) {
  return passed.passed && passed.calibration == failed.calibration &&
         (passed.read_leds || failed.only_bodies_moved);
}

/// The time when what a check found was last known not to be so.
double held_until(const Records& records, const DatedCheck& failed) {
  double time_s = -std::numeric_limits<double>::infinity();
  for (const DatedCalibration& each : records.calibrations) {
    if (each.calibration.id == failed.calibration) time_s = std::max(time_s, each.time_s);
  }
  for (const DatedCheck& check : records.checks) {
    if (clears(check, failed) && check.time_s <= failed.time_s) time_s = std::max(time_s, check.time_s);
  }
  return time_s;
}

/// Whether what a check found had been put right by a time after it.
bool put_right_by(const Records& records, const DatedCheck& failed, double time_s) {
  return std::any_of(records.checks.begin(), records.checks.end(), [&](const DatedCheck& check) {
    return clears(check, failed) && check.time_s > failed.time_s && check.time_s < time_s;
  });
}

/// The check that speaks against a calibration at a time: the last one before that found it moved, else the
/// first one after; null where none does.
const DatedCheck* check_against(const Records& records, const std::string& calibration, double time_s) {
  const DatedCheck* against = nullptr;
  for (const DatedCheck& check : records.checks) {
    if (check.passed || check.calibration != calibration) continue;
    if (check.time_s < time_s) {
      if (!put_right_by(records, check, time_s)) against = &check;
    } else if (against == nullptr && time_s > held_until(records, check)) {
      return &check;
    }
  }
  return against;
}

/// The calibration that the rig has now.
struct CalibrationNow {
  fs::path folder;
  std::string id;
};

CalibrationNow calibration_now(const CalibrateHistoryOptions& options, const Records& records,
                               std::vector<std::string>& warnings) {
  if (!options.calibration.empty()) {
    const Result<Calibration> named = read_calibration(options.calibration);
    if (named) return {options.calibration, named->id};
    warnings.push_back(named.error().message());
  }
  const DatedCalibration& newest = records.calibrations.back();
  return {options.rig / newest.name, newest.calibration.id};
}

bool is_solved_by(const Session& session, const std::string& calibration) {
  const solve::SessionSolves solves = solve::solves_of(session);
  const solve::ChoosableSolve* const current = solves.current_one();
  if (current == nullptr) return false;
  const Result<Json> document = read_json(current->folder / kSolveProduct.document, kSolveProduct.schema, 1);
  const Json input = document ? document->value("input", Json()) : Json();
  return input.is_object() && input.value("calibration", Json()) == Json(calibration);
}

/// Whether a look knows that what a check found is not so in its session.
bool clears(const RigLook& look, const DatedCheck& failed) {
  return !look.is_bad() && look.state != RigPlace::kUnseen &&
         (failed.only_bodies_moved || !look.seen.patches.empty());
}

bool explains_better(const CalibrationNow& now, const RigLook& look) {
  if (now.id == look.calibration) return false;
  const Result<RigLook> by_now = look_by_another(look, now.folder);
  if (!by_now) return false;
  if (by_now->is_bad() != look.is_bad()) return look.is_bad();
  return by_now->cost.mean_deg < look.cost.mean_deg && by_now->chi_square < 2 * look.chi_square;
}

/// How a session stands to the moves of its rig; nothing where it is not affected.
std::optional<AffectedSession> affected(const Session& session, const std::string& time, double time_s,
                                        const std::optional<RigLook>& look, const DatedCheck* check,
                                        const CalibrationNow& now) {
  const bool is_shown = look && look->is_bad();
  if (!is_shown && (check == nullptr || (look && clears(*look, *check)))) return std::nullopt;
  if (is_solved_by(session, now.id) && now.id != session.calibration_id) return std::nullopt;
  AffectedSession found = {.folder = session.folder, .time = time};
  if (look) found.says = look->says;
  if (is_shown) {
    found.predicted_mean_deg = look->cost.mean_deg;
    found.predicted_worst_deg = look->cost.worst_deg;
    found.after_move = true;
    found.is_concerned = explains_better(now, *look);
  } else {
    found.predicted_mean_deg = check->mean_deg;
    found.predicted_worst_deg = check->worst_deg;
    found.after_move = check->time_s < time_s;
    found.is_concerned = found.after_move && now.id != session.calibration_id;
  }
  return found;
}

Result<void> find_affected(const fs::path& folder, const Records& records, const CalibrationNow& now,
                           CalibrationHistory& history) {
  const Result<std::vector<fs::path>> folders = folders_with(folder, "session.json");
  if (!folders) return folders.error();
  for (const fs::path& path : *folders) {
    const Result<Session> session = read_session(path);
    if (!session) {
      history.warnings.push_back(session.error().message());
      continue;
    }
    ++history.sessions;
    const std::string time = session->shots.empty() ? "" : session->shots.front().time;
    const auto time_s = seconds_of_iso_time(time);
    if (!time_s) {
      ++history.without_time;
      history.warnings.push_back(fmt::format(
          "{} says no time at which it was taken: whether a move affects it is not known", path.string()));
      continue;
    }
    const std::optional<RigLook> look = kept_look(*session);
    if (look) history.looks.push_back({path, *look});
    const DatedCheck* const check = check_against(records, session->calibration_id, *time_s);
    if (const auto found = affected(*session, time, *time_s, look, check, now))
      history.affected.push_back(*found);
  }
  std::ranges::stable_sort(history.looks, {}, [](const DatedLook& each) { return each.look.taken; });
  return {};
}

/// What scanning on would have cost, scan by scan.
report::Section looks_section(const std::vector<DatedLook>& all, Json& numbers) {
  report::Section section = {"Scans", {}, report::Table{}, {}};
  section.paragraphs = {
      "What each scan shows of its rig beside the cloth, against the calibration that it was taken with."};
  section.is_answer = true;
  section.table->header = {"taken", "session", "state", "what is seen", "cost, degrees"};
  report::PlotSeries cost = {.name = "cost"};
  const double first_s = seconds_of_iso_time(all.front().look.taken).value_or(0);
  for (const auto& [folder, look] : all) {
    const char* const state = kRigPlaceNames[static_cast<std::size_t>(look.state)];
    section.table->rows.push_back({look.taken, folder.stem().string(), state, look.says,
                                   look.state == RigPlace::kUnseen ? "" : number(look.cost.mean_deg, 3)});
    numbers["looks"].push_back({{"session", folder.stem().string()},
                                {"taken", look.taken},
                                {"state", state},
                                {"says", look.says},
                                {"cost_mean_deg", look.cost.mean_deg}});
    if (look.state != RigPlace::kUnseen)
      cost.points.push_back(
          {(seconds_of_iso_time(look.taken).value_or(0) - first_s) / kDay_s, look.cost.mean_deg});
  }
  if (cost.points.size() > 1)
    section.figures.push_back(
        {"What scanning on would have cost",
         report::plot_svg({.x_label = "days", .y_label = "degrees", .series = {cost}})});
  return section;
}

report::Section affected_section(const std::vector<AffectedSession>& all, Json& numbers) {
  report::Section section = {"Affected sessions", {}, report::Table{}, {}};
  section.paragraphs = {
      "These show themselves that the rig had moved, or were taken after the last check that their "
      "calibration passed and show nothing. Those up to the check that found the move are perhaps from "
      "before it, and then have no error. Solve again those that the calibration of now explains better. A "
      "check on sheets predicts no error of a session."};
  section.is_answer = true;
  section.table->header = {"session",  "taken", "after the move", "predicted mean error, degrees",
                           "at worst", "shows", "solve again"};
  numbers["affected"] = Json::array();
  for (const AffectedSession& each : all) {
    section.table->rows.push_back({each.folder.string(), each.time, each.after_move ? "yes" : "perhaps",
                                   number(each.predicted_mean_deg, 2), number(each.predicted_worst_deg, 2),
                                   each.says, each.is_concerned ? "yes" : ""});
    Json json = {{"session", each.folder.string()},
                 {"time", each.time},
                 {"after_move", each.after_move},
                 {"says", each.says},
                 {"concerned", each.is_concerned}};
    if (each.predicted_mean_deg) json["predicted_mean_deg"] = *each.predicted_mean_deg;
    if (each.predicted_worst_deg) json["predicted_worst_deg"] = *each.predicted_worst_deg;
    numbers["affected"].push_back(std::move(json));
  }
  return section;
}

}  // namespace

Result<std::vector<ListedCalibration>> list_calibrations(const fs::path& rig) {
  const Result<std::vector<fs::path>> folders = folders_with(rig, "calibration.json");
  if (!folders) return folders.error();
  std::vector<ListedCalibration> all;
  for (const fs::path& folder : *folders) {
    const Result<Calibration> calibration = read_calibration(folder);
    if (!calibration) continue;
    all.push_back({folder, calibration->id, calibration->subject.measured, parts_of(*calibration),
                   last_check_of(folder, calibration->id)});
  }
  std::ranges::stable_sort(all, std::greater{}, &ListedCalibration::measured);
  return all;
}

Result<CalibrationHistory> calibrate_history(const CalibrateHistoryOptions& options,
                                             const JobContext& context) {
  Records records;
  if (Result<void> ok = read_calibrations(options.rig, records); !ok) return std::move(ok).error();
  if (records.calibrations.empty()) {
    return Error{
        ErrorKind::kNoInput, "there is no calibration", options.rig.string(),
        records.warnings.empty() ? "no folder in it holds calibration.json" : records.warnings.front(),
        "name the folder that holds the rig's calibrations"};
  }
  if (context.stop.stop_requested()) return interrupted();
  if (Result<void> ok = read_checks(options.rig, records); !ok) return std::move(ok).error();
  CalibrationHistory history;
  history.warnings = std::move(records.warnings);
  CalibrationReport& report = history.report;
  report.part = "history";
  report.title = fmt::format("History of {}", records.calibrations.back().calibration.subject.rig);
  report.sections.push_back(calibrations_section(records.calibrations, report.numbers));
  if (!records.checks.empty()) report.sections.push_back(checks_section(records.checks, report.numbers));
  const std::size_t calibrations = records.calibrations.size(), checks = records.checks.size();
  report.summary = fmt::format("{} calibration{} and {} check{}", calibrations, calibrations == 1 ? "" : "s",
                               checks, checks == 1 ? "" : "s");
  if (!options.sessions.empty()) {
    const CalibrationNow now = calibration_now(options, records, history.warnings);
    if (Result<void> ok = find_affected(options.sessions, records, now, history); !ok)
      return std::move(ok).error();
    if (!history.looks.empty()) report.sections.push_back(looks_section(history.looks, report.numbers));
    report.sections.push_back(affected_section(history.affected, report.numbers));
    report.summary +=
        fmt::format(", {} of {} sessions affected by a move", history.affected.size(), history.sessions);
    if (history.without_time > 0)
      report.summary += fmt::format(", {} without a time cannot be told", history.without_time);
    report.numbers["sessions"] = history.sessions;
    report.numbers["sessions_without_time"] = history.without_time;
  }
  if (options.output.empty()) return history;
  if (Result<void> ok = write_report(report, options.output); !ok) return std::move(ok).error();
  return history;
}

}  // namespace weft::calibration
