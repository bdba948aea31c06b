// SPDX-License-Identifier: Apache-2.0
// Walks from photographs to a calibration that the rig scans with: the whole of a new rig, or what a knock
// made necessary. Where a walk stands is what lies beside the rig file: sets/NAME-..., calibrations/NAME-....
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cli/calibrate.h"
#include "app/cli/exit_code.h"
#include "app/cli/opened_devices.h"
#include "app/cli/rig_options.h"
#include "app/cli/set_capture.h"
#include "app/cli/terminal.h"
#include "calibration/guide/photograph_set.h"
#include "calibration/guide/walk.h"
#include "calibration/run/calibrate_camera.h"
#include "calibration/run/calibrate_color.h"
#include "calibration/run/calibrate_lights.h"
#include "calibration/run/calibrate_response.h"
#include "calibration/run/check.h"
#include "calibration/run/last_check.h"
#include "calibration/run/update.h"
#include "capture/rig.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDateLength = 10;  // "2026-11-21"

struct WalkArguments {
  fs::path rig, board, sheet, chart;
  std::string name;
  bool trap = false, once = false, enough = false, yes = false;
};

using SetWork = Result<calibration::CalibrateOutcome> (*)(const fs::path& set, const fs::path& from,
                                                          const fs::path& output, const JobContext& context);

/// One of the walk, as it is told.
struct Stage : calibration::WalkStage {
  fs::path description;  ///< of its board, sheet or chart; empty: not told
  SetWork work;          ///< of the set in a folder, by a calibration, into another folder
};

/// The work whose options name a set, a calibration and an output.
template <auto kInput, auto kWork, typename WorkOptions>
Result<calibration::CalibrateOutcome> of_set(const fs::path& set, const fs::path& from,
                                             const fs::path& output, const JobContext& context) {
  WorkOptions options;
  options.*kInput = set;
  options.from = from;
  options.output = output;
  return kWork(options, context);
}

constexpr SetWork camera = of_set<&calibration::CalibrateCameraOptions::input, calibration::calibrate_camera,
                                  calibration::CalibrateCameraOptions>,
                  lights = of_set<&calibration::CalibrateLightsOptions::input, calibration::calibrate_lights,
                                  calibration::CalibrateLightsOptions>,
                  color = of_set<&calibration::CalibrateColorOptions::input, calibration::calibrate_color,
                                 calibration::CalibrateColorOptions>,
                  proof = of_set<&calibration::CalibrateCheckOptions::input, calibration::calibrate_check,
                                 calibration::CalibrateCheckOptions>,
                  moved = of_set<&calibration::CheckRigOptions::session, calibration::calibrate_check_rig,
                                 calibration::CheckRigOptions>,
                  update = of_set<&calibration::CalibrateUpdateOptions::session,
                                  calibration::calibrate_update, calibration::CalibrateUpdateOptions>;

/// With the black trap of the same walk, where there is one.
Result<calibration::CalibrateOutcome> response(const fs::path& set, const fs::path& from,
                                               const fs::path& output, const JobContext& context) {
  calibration::CalibrateResponseOptions options;
  options.input = set;
  options.from = from;
  options.output = output;
  const std::string name = set.filename().string();
  const fs::path trap = set.parent_path() / (name.substr(0, name.rfind('-')) + "-trap");
  if (is_there(trap)) options.trap = trap;
  return calibration::calibrate_response(options, context);
}

SetWork work_of(const calibration::WalkStage& stage) {
  if (stage.part == calibration::kWalkMoved) return stage.job == "check" ? moved : update;
  constexpr std::array<std::pair<std::string_view, SetWork>, 5> kWorks = {{{"calibrate_camera", camera},
                                                                           {"calibrate_response", response},
                                                                           {"calibrate_lights", lights},
                                                                           {"calibrate_color", color},
                                                                           {"check", proof}}};
  return std::ranges::find(kWorks, stage.job, &std::pair<std::string_view, SetWork>::first)->second;
}

/// Optional ones are those that were asked for.
std::vector<Stage> stages_of(std::span<const calibration::WalkStage> walk, const WalkArguments& a) {
  std::vector<Stage> stages;
  for (const calibration::WalkStage& each : walk) {
    const fs::path& description = each.thing == "board" ? a.board : each.thing == "chart" ? a.chart : a.sheet;
    const bool is_asked = each.is_aside ? a.trap : !description.empty();
    if (!each.is_optional || is_asked) stages.push_back({each, description, work_of(each)});
  }
  return stages;
}

std::vector<Stage> stages_of_all(const WalkArguments& a) {
  return stages_of(calibration::walk_of_all(), a);
}

std::vector<Stage> stages_of_refresh(const WalkArguments& a) {
  return stages_of(calibration::walk_of_refresh(), a);
}

bool has_passed(const fs::path& result) {
  const Result<calibration::CheckResult> said = calibration::read_check_result(result);
  return said && said->passed;
}

class Walk {
 public:
  Walk(const capture::Rig& rig, const WalkArguments& a, const CommonArguments& common)
      : folder_(rig.folder()), rig_(rig), a_(a), common_(common), name_(a.name) {
    const std::string today = iso_time_now().substr(0, kDateLength);
    for (int number = 1; name_.empty(); ++number) {
      const std::string name = number == 1 ? today : fmt::format("{}-{}", today, number);
      if (!has_ended(name)) name_ = name;
    }
  }

  Result<int> go(const std::vector<Stage>& stages) {
    note(fmt::format("--name {0}: sets/{0}-... and calibrations/{0}-... beside {1}", name_,
                     rig_.file.string()));
    if (Result<void> ok = check_described(stages); !ok) return std::move(ok).error();
    fs::path calibration = rig_.scan.calibration;
    for (const Stage& stage : stages) {
      if (stage.is_aside) {
        const Result<bool> is_complete = photograph(stage, calibration);
        if (!is_complete) return is_complete.error();
        if (!*is_complete) return kDone;
        continue;
      }
      const fs::path result = result_of(name_, stage.result);
      if (!is_there(result)) {
        const Result<std::optional<calibration::CalibrateOutcome>> done = take(stage, calibration, result);
        if (!done) return done.error();
        if (!*done) return kDone;  // a person stopped here
      }
      if (stage.result == calibration::kWalkCheck && !has_passed(result)) return failed(result);
      if (stage.result == calibration::kWalkMoved && has_passed(result)) return kDone;
      if (stage.result != calibration::kWalkMoved && stage.result != calibration::kWalkCheck)
        calibration = result;
    }
    return accept(calibration);
  }

 private:
  Error failed(const fs::path& check) const {
    return {ErrorKind::kBadData, "the calibration did not pass its check", check.string(),
            "its report says where it fails", "mend that, then begin again under another --name"};
  }

  fs::path result_of(const std::string& name, std::string_view part) const {
    return folder_ / "calibrations" / fmt::format("{}-{}", name, part);
  }
  fs::path set_of(const Stage& stage) const {
    return folder_ / "sets" / fmt::format("{}-{}", name_, stage.part);
  }
  bool has_ended(const std::string& name) const {
    return is_there(result_of(name, calibration::kWalkCheck)) ||
           has_passed(result_of(name, calibration::kWalkMoved));
  }

  /// The photographs that a stage lacks, and its result; nothing where more are to be taken later.
  Result<std::optional<calibration::CalibrateOutcome>> take(const Stage& stage, const fs::path& from,
                                                            const fs::path& output) {
    const Result<bool> is_complete = photograph(stage, from);
    if (!is_complete) return is_complete.error();
    if (!*is_complete) return std::optional<calibration::CalibrateOutcome>();
    if (Result<void> ok = make_writable_folder(output.parent_path()); !ok) return ok.error();
    Result<calibration::CalibrateOutcome> outcome = run_and_print(
        [&](const JobContext& context) { return stage.work(set_of(stage), from, output, context); }, common_);
    if (!outcome) return std::move(outcome).error();
    return std::optional(std::move(*outcome));
  }

  /// Whether every board and sheet is described that is not photographed yet.
  Result<void> check_described(const std::vector<Stage>& stages) const {
    for (const Stage& stage : stages) {
      const std::string part(stage.part);
      const bool needs_none = stage.thing.empty() || stage.thing == "chart";
      if (needs_none || is_there(set_of(stage)) || !stage.description.empty()) continue;
      if (!calibration::newest_description(folder_ / "sets", *calibration::set_part_of(part)).empty())
        continue;
      return Error{
          ErrorKind::kUsage, fmt::format("nobody said what the {} is", stage.thing),
          fmt::format("--{}", stage.thing), "its size and pattern must be known to find it",
          fmt::format("print one: weft target {0}; or write a {0}.toml (docs/calibration.md) and name it",
                      stage.thing)};
    }
    return {};
  }

  /// Whether all photographs of a set are there.
  Result<bool> photograph(const Stage& stage, const fs::path& from) {
    if (!common_.json) print(fmt::format("-- {} --", stage.is_aside ? stage.part : stage.result));
    if (!devices_) {
      auto opened = OpenedDevices::open(rig_);
      if (!opened) return opened.error();
      devices_ = std::move(*opened);
    }
    SetCapture capture(devices_->client(), common_, [&] { tell_so_far(stage, from); });
    const fs::path description = is_there(set_of(stage)) ? fs::path() : stage.description;
    const std::string name = set_of(stage).filename().string();
    if (Result<void> begun = capture.begin({std::string(stage.part), name, description, from}); !begun)
      return begun.error();
    if (!a_.once && !a_.enough) return capture.converse(stop_on_signal());
    if (std::exchange(is_enough_, false)) return true;
    if (!capture.is_complete() && !std::exchange(is_taken_, true)) {
      if (const Result<bool> taken = capture.photograph(stop_on_signal()); !taken) return taken.error();
    }
    common_.json ? print_json(capture.set()) : capture.print_progress();
    return capture.is_complete();
  }

  /// What the sheets that there are say of the LEDs. One that contradicts the others is told at once.
  void tell_so_far(const Stage& stage, const fs::path& from) const {
    if (stage.part != "sheet" || common_.json) return;
    const Result<calibration::CalibrateOutcome> outcome =
        lights(set_of(stage), from, {}, {common_.threads, stop_on_signal()});
    if (outcome) {
      print("  so far: " + outcome->report.summary);
    } else {
      complain(outcome.error());
    }
  }

  Result<int> accept(const fs::path& calibration) {
    if (rig_.scan.calibration == calibration) return kDone;
    if (Result<void> said = print_change(rig_.file, calibration, a_.yes, common_); !said) return said.error();
    if (!a_.yes && (a_.once || !is_agreed())) {
      note("to scan with it: weft calibrate accept " + calibration.string());
      return kDone;
    }
    const Result<void> accepted = accept_calibration(rig_.file, calibration);
    return accepted ? Result<int>(kDone) : accepted.error();
  }

  static bool is_agreed() {
    note("y: it becomes the rig's; anything else: it does not");
    return typed_line(stop_on_signal()) == "y";
  }

  const fs::path folder_;
  const capture::Rig& rig_;
  const WalkArguments& a_;
  const CommonArguments& common_;
  std::string name_;
  bool is_enough_ = a_.enough;  ///< the set that comes first
  bool is_taken_ = a_.enough;   ///< the one photograph of --once
  std::unique_ptr<OpenedDevices> devices_;
};

Run run_walk(Options& options, const std::shared_ptr<WalkArguments>& a,
             std::vector<Stage> (*stages)(const WalkArguments&)) {
  add_rig_file(options, a->rig);
  options.add("--sheet", &a->sheet,
              "sheet.toml: the white sheet (docs/calibration.md); default that of the rig's newest set");
  options.add("--name", &a->name, "Of this walk, to go on with it on another day; default the date");
  options.add_flag("--once", &a->once, "Take one photograph, do what follows from it, and end");
  options.add_flag("--enough", &a->enough, "Go on with the photographs of this step that there are, and end");
  options.add_flag("--yes", &a->yes, "Make the new calibration the rig's without asking");
  return [a, stages](const CommonArguments& common) -> Result<int> {
    const Result<capture::Rig> rig = capture::read_rig(find_rig(a->rig));
    if (!rig) return rig.error();
    return Walk(*rig, *a, common).go(stages(*a));
  };
}

Run add_all(Options& options) {
  const auto a = std::make_shared<WalkArguments>();
  options.add("--board", &a->board, "board.toml: the printed board; default that of the rig's newest set");
  options.add("--chart", &a->chart, "chart.toml: the colour chart; default colour is not measured");
  options.add_flag("--trap", &a->trap,
                   "The veil of the lens is measured, too, by a black trap in white paper");
  return run_walk(options, a, stages_of_all);
}

Run add_refresh(Options& options) {
  return run_walk(options, std::make_shared<WalkArguments>(), stages_of_refresh);
}

}  // namespace

Verb calibrate_all_verb() {
  return {"all", "A new rig, step by step: from photographs to a proven calibration", add_all};
}

Verb calibrate_refresh_verb() {
  return {"refresh", "A knocked rig, step by step: what moved is seen, fitted again and proven", add_refresh};
}

}  // namespace weft::app
