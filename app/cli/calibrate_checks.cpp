// SPDX-License-Identifier: Apache-2.0
// The steps that look at what was measured: whether it holds, what moved, and how it went over time.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/calibrate.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/jobs/calibrate/accept.h"
#include "app/jobs/calibrate/check.h"
#include "app/jobs/calibrate/history.h"
#include "app/jobs/calibrate/patches.h"
#include "app/jobs/calibrate/update.h"
#include "capture/rig.h"

namespace weft::app {
namespace {

void add_paper_delta(Options& options, std::optional<double>& paper_delta) {
  options
      .add("--paper-delta", &paper_delta,
           "The paper reflects 1 - delta (1 - cosine) of Lambert's law; default as the lights' report has it")
      .in_range(-0.5, 1.0);
}

// What a scan is looked at for: both kinds of check, and update.
void add_evidence(Options& options, std::filesystem::path& from, std::filesystem::path& sheet,
                  const std::string& about_sheet, std::optional<double>& paper_delta) {
  options.add("--from", &from, "The calibration in question; default each session's own");
  options.add("--sheet", &sheet, about_sheet);
  add_paper_delta(options, paper_delta);
}

void add_limits(Options& options, calibration::CheckLimits& limits) {
  options.add("--flat-limit", &limits.flat_rms_deg, "Of flat sheets, rms degrees")
      .above_zero()
      .shows_default();
  options.add("--tilted-limit", &limits.tilted_rms_deg, "Of tilted sheets, rms degrees")
      .above_zero()
      .shows_default();
  options.add("--gain-limit", &limits.slope_gain, "Of the slope gain, off 1").above_zero().shows_default();
  options.add("--drift-limit", &limits.drift, "Of a LED that is lit once more, relative")
      .above_zero()
      .shows_default();
}

Result<CalibrateOutcome> check(const CalibrateCheckOptions& sheets, const std::filesystem::path& session,
                               const JobContext& context) {
  if (!session.empty()) {
    CheckRigOptions rig;
    rig.session = session;
    rig.from = sheets.from;
    rig.sheet = sheets.sheet;
    rig.output = sheets.output;
    rig.paper_delta = sheets.paper_delta;
    return calibrate_check_rig(rig, context);
  }
  if (!sheets.input.empty()) return calibrate_check(sheets, context);
  return Error{ErrorKind::kUsage, "nothing to check", "weft calibrate check", "neither input nor --session",
               "name a session of a sheet, a folder of them, or a scan by --session"};
}

Run add_check(Options& options) {
  const auto a = std::make_shared<CalibrateCheckOptions>();
  const auto session = std::make_shared<std::filesystem::path>();
  const Option input = options.add("input", &a->input, "Session of a sheet, or a folder of sessions");
  options.add("--session", session.get(), "Any scan that shows tags, white patches or the sheet")
      .excludes(input);
  add_evidence(options, a->from, a->sheet,
               "sheet.toml of the sheet in the pictures; default that beside them, with --session no sheet",
               a->paper_delta);
  options.add("-o,--output", &a->output, "Folder for result and report; default nothing is written");
  options.add("--square-px", &a->square_px, "Side of the squares that are compared, pixels")
      .in_range(8, 512)
      .shows_default();
  add_limits(options, a->limits);
  return run_check(options, [a, session](const JobContext& context) { return check(*a, *session, context); });
}

Run add_patches(Options& options) {
  const auto a = std::make_shared<CalibratePatchesOptions>();
  options.add("session", &a->session, "A scan of the table while the calibration is fresh").required();
  options.add("--patches", &a->patches, "patches.toml: where they lie; default beside the session");
  options.add("--from", &a->from, "The calibration to add them to; default the session's own");
  add_paper_delta(options, a->paper_delta);
  options.add("-o,--output", &a->output, "Folder of the new calibration, which must not exist").required();
  return run_step(options, [a](const JobContext& context) { return calibrate_patches(*a, context); });
}

Run add_update(Options& options) {
  const auto a = std::make_shared<CalibrateUpdateOptions>();
  options.add("session", &a->session, "A scan after the move that shows tags, white patches or the sheet")
      .required();
  add_evidence(options, a->from, a->sheet, "sheet.toml of the sheet in the pictures; default no sheet",
               a->paper_delta);
  options.add("-o,--output", &a->output, "Folder of the new calibration, which must not exist").required();
  return run_step(options, [a](const JobContext& context) { return calibrate_update(*a, context); });
}

Run add_history(Options& options) {
  const auto a = std::make_shared<CalibrateHistoryOptions>();
  options.add("rig", &a->rig, "Folder that holds calibrations and results of checks").required();
  options.add("--affected", &a->sessions,
              "Folder of sessions: lists those shot between the last check that passed and a move");
  options.add("-o,--output", &a->output, "Folder to make for the page; default none");
  return run_step(options, [a](const JobContext& context) -> Result<CalibrateOutcome> {
    Result<CalibrationHistory> history = calibrate_history(*a, context);
    if (!history) return std::move(history).error();
    return CalibrateOutcome{a->output, {}, std::move(history->report), std::move(history->warnings)};
  });
}

struct AcceptArguments {
  std::filesystem::path calibration, rig;
  bool dry_run = false;
};

Result<int> accept(const AcceptArguments& a, const CommonArguments& common) {
  const std::filesystem::path file = find_rig(a.rig);
  const Result<capture::Rig> rig = capture::read_rig(file);
  if (!rig) return rig.error();
  const Result<CalibrationChange> change = change_between(rig->scan.calibration, a.calibration);
  if (!change) return change.error();
  const std::vector<std::string> words = words_of(*change);
  if (common.json) {
    Json maps;
    if (change->maps) {
      maps = {{"mean_deg", change->maps->mean_deg},
              {"worst_deg", change->maps->worst_deg},
              {"albedo_factor", 1 / change->maps->albedo_factor},
              {"albedo_unevenness", change->maps->albedo_unevenness}};
    }
    print_json({{"from", change->old_id},
                {"to", change->new_id},
                {"maps", maps},
                {"gained", change->gained},
                {"lost", change->lost},
                {"warning", change->warning},
                {"accepted", !a.dry_run}});
  } else {
    for (const std::string& line : words) print(line);
  }
  if (!change->warning.empty()) note(change->warning);
  if (a.dry_run) return kDone;
  if (Result<void> named = name_calibration(file, a.calibration); !named) return named.error();
  note(file.string() + " names it from now on; a daemon of this rig reads it when it starts again");
  return kDone;
}

Run add_accept(Options& options) {
  const auto a = std::make_shared<AcceptArguments>();
  options.add("calibration", &a->calibration, "Folder of the calibration that is to be the rig's").required();
  add_rig_file(options, a->rig);
  options.add_flag("--dry-run", &a->dry_run, "Only say what would change");
  return [a](const CommonArguments& common) { return accept(*a, common); };
}

}  // namespace

Verb calibrate_accept_verb() {
  return {"accept", "Say in degrees and albedo what a calibration changes, and make it the rig's",
          add_accept};
}

Verb calibrate_check_verb() {
  return {
      "check",
      "Accept or refuse a calibration on sheets it was not fitted to; with --session, see what moved. Exit "
      "code 65 where it does not hold",
      add_check};
}

Verb calibrate_patches_verb() {
  return {"patches", "White patches beside the cloth, by which later scans tell drift and moves",
          add_patches};
}

Verb calibrate_update_verb() {
  return {"update", "Fit again what moved, the rest held by its prior", add_update};
}

Verb calibrate_history_verb() {
  return {"history", "What was measured of a rig over time", add_history};
}

}  // namespace weft::app
