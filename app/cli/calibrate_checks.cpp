// SPDX-License-Identifier: Apache-2.0
// The steps that look at what was measured: whether it holds, what moved, and how it went over time.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/calibrate.h"
#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/rig_owner.h"
#include "app/cli/terminal.h"
#include "app/server/rig/rig_lock.h"
#include "calibration/run/accept.h"
#include "calibration/run/calibrate_patches.h"
#include "calibration/run/check.h"
#include "calibration/run/history.h"
#include "calibration/run/update.h"
#include "capture/rig.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

Result<calibration::CalibrateOutcome> check(const calibration::CalibrateCheckOptions& sheets,
                                            const JobContext& context) {
  if (!sheets.session.empty()) {
    calibration::CheckRigOptions rig;
    rig.session = sheets.session;
    rig.from = sheets.from;
    rig.sheet = sheets.sheet;
    rig.output = sheets.output;
    rig.paper_delta = sheets.paper_delta;
    return calibration::calibrate_check_rig(rig, context);
  }
  return calibration::calibrate_check(sheets, context);
}

Run add_check(Options& options) {
  const auto a = std::make_shared<calibration::CalibrateCheckOptions>();
  add_options(options, *a);
  return run_check(options, [a](const JobContext& context) { return check(*a, context); });
}

Run add_patches(Options& options) {
  const auto a = std::make_shared<calibration::CalibratePatchesOptions>();
  add_options(options, *a);
  return run_step(options,
                  [a](const JobContext& context) { return calibration::calibrate_patches(*a, context); });
}

Run add_update(Options& options) {
  const auto a = std::make_shared<calibration::CalibrateUpdateOptions>();
  add_options(options, *a);
  return run_step(options,
                  [a](const JobContext& context) { return calibration::calibrate_update(*a, context); });
}

/// Has the daemon of the rig solve those again that were taken after a move. `folder`: where the rig file
/// lies, else it is looked for as always.
Result<void> solve_again(const std::vector<calibration::AffectedSession>& affected,
                         const std::filesystem::path& folder, const std::filesystem::path& calibration) {
  const std::filesystem::path file = folder / "rig.toml";
  const Result<capture::Rig> rig =
      capture::read_rig(find_rig(is_there(file) ? file : std::filesystem::path()));
  if (!rig) return rig.error();
  const Result<std::optional<std::string>> owner = address_of_owner(*rig);
  if (!owner) return owner.error();
  if (!*owner) {
    return Error{ErrorKind::kTryAgain, "nobody takes jobs", rig->file.string(),
                 "no daemon of this rig is running", "start weft serve"};
  }
  const Result<RigClient> daemon = connect_to_owner(*rig, **owner);
  if (!daemon) return daemon.error();
  const std::string below = absolute_folder(calibration).lexically_relative(rig->folder()).string();
  int queued = 0;
  for (const calibration::AffectedSession& each : affected) {
    if (!each.is_concerned) continue;
    const Result<Json> job =
        daemon->post("/api/v1/jobs",
                     {{"kind", "solve"}, {"session", each.folder.stem().string()}, {"calibration", below}});
    if (!job) return job.error();
    ++queued;
  }
  note(
      fmt::format("{} of {} sessions are solved again by {}; it explains the others no better, or they were "
                  "perhaps taken "
                  "before the move",
                  queued, affected.size(), below));
  return {};
}

Run add_history(Options& options) {
  const auto a = std::make_shared<calibration::CalibrateHistoryOptions>();
  options.add("rig", &a->rig, "Folder that holds calibrations and results of checks").required();
  const Option affected = options.add(
      "--affected", &a->sessions,
      "Folder of sessions: lists those that a move spoiled, by what each shows of the rig (weft rig "
      "check), else by its date");
  options.add("-o,--output", &a->output, "Folder to make for the page; default none");
  options
      .add("--solve", &a->calibration,
           "With --affected: the rig's daemon solves those again that this calibration explains better")
      .needs(affected);
  return run_step(options, [a](const JobContext& context) -> Result<calibration::CalibrateOutcome> {
    Result<calibration::CalibrationHistory> history = calibration::calibrate_history(*a, context);
    if (!history) return std::move(history).error();
    if (!a->calibration.empty()) {
      if (Result<void> queued = solve_again(history->affected, a->rig, a->calibration); !queued)
        return std::move(queued).error();
    }
    return calibration::CalibrateOutcome{
        a->output, {}, std::move(history->report), std::move(history->warnings)};
  });
}

struct AcceptArguments {
  std::filesystem::path calibration, rig;
  bool dry_run = false;
};

}  // namespace

Result<void> print_change(const std::filesystem::path& rig_file, const std::filesystem::path& calibration,
                          bool is_accepted, const CommonArguments& common) {
  const Result<capture::Rig> rig = capture::read_rig(rig_file);
  if (!rig) return rig.error();
  const Result<calibration::CalibrationChange> change =
      calibration::change_between(rig->scan.calibration, calibration);
  if (!change) return change.error();
  if (common.json) {
    Json document = json_of(*change);
    document["accepted"] = is_accepted;
    print_json(document);
  } else {
    for (const std::string& line : words_of(*change)) print(line);
  }
  if (!change->warning.empty()) note(change->warning);
  return {};
}

Result<void> accept_calibration(const std::filesystem::path& rig_file,
                                const std::filesystem::path& calibration) {
  if (Result<void> named = calibration::name_calibration(rig_file, calibration); !named) return named;
  note(rig_file.string() + " names it from now on");
  return {};
}

namespace {

Run add_accept(Options& options) {
  const auto a = std::make_shared<AcceptArguments>();
  options.add("calibration", &a->calibration, "Folder of the calibration that is to be the rig's").required();
  add_rig_file(options, a->rig);
  options.add_flag("--dry-run", &a->dry_run, "Only say what would change");
  return [a](const CommonArguments& common) -> Result<int> {
    const std::filesystem::path file = find_rig(a->rig);
    if (const Result<void> said = print_change(file, a->calibration, !a->dry_run, common); !said)
      return said.error();
    if (a->dry_run) return kDone;
    const Result<void> accepted = accept_calibration(file, a->calibration);
    return accepted ? Result<int>(kDone) : accepted.error();
  };
}

}  // namespace

Verb calibrate_accept_verb() {
  return {"accept", "Say in degrees and albedo what a calibration changes, and make it the rig's",
          add_accept};
}

Verb calibrate_check_verb() {
  return {"check",
          "Accept or refuse a calibration on sheets it was not fitted to; with --session, a report of what "
          "`weft rig check` tells. Exit code 65 where it does not hold",
          add_check};
}

Verb calibrate_patches_verb() {
  return {"patches", "White patches beside the cloth, by which later scans tell drift and moves",
          add_patches};
}

Verb calibrate_update_verb() {
  return {
      "update",
      "What refresh fits, from photographs that were taken already: what moved, the rest held by its prior",
      add_update};
}

Verb calibrate_history_verb() {
  return {"history", "What was measured of a rig over time", add_history};
}

}  // namespace weft::app
