// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/studies.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "calibration/checks/movement.h"
#include "core/calibration.h"
#include "core/files.h"
#include "core/temporary_folder.h"
#include "simulator/scene/resolution.h"
#include "simulator/scene/rig.h"
#include "simulator/scene/scene.h"
#include "virtual_rig/rig_process.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr double kPatience_s = 300;
constexpr double kLaying_s = 20;  // that a person takes to lay a thing on the table

/// A thing that is laid, and the row that follows from its photograph; none: the next thing follows.
struct Step {
  const char* lays;
  const char* after = nullptr;
  const char* result = nullptr;  ///< of the walk; null: lights by the sheets there are
  bool is_enough = false;        ///< of this part's photographs
};

const std::vector<Step>& steps() {
  static const std::vector<Step> kSteps = {
      {"board"},
      {"board tilt=40 azimuth=225 x=17 y=-14 height=57"},
      {"board tilt=40 azimuth=0 x=20 y=11 height=57"},
      {"board tilt=40 azimuth=180 x=-20 y=11 height=57"},
      {"board tilt=40 azimuth=45 x=-18 y=-14 height=57"},
      {"board tilt=15 azimuth=135 x=-25 y=-19 height=57", "the board in six poses", "camera", true},
      {"sheet"},
      {"empty", "pairs of photographs, lit and dark", "response"},
      {"sheet", "one sheet"},
      {"sheet tilt=20 azimuth=0", "two sheets"},
      {"sheet tilt=20 azimuth=180", "three sheets"},
      {"sheet tilt=20 azimuth=90", "four sheets"},
      {"sheet tilt=20 azimuth=270", "five sheets", "lights"}};
  return kSteps;
}

class RigMinutes {
 public:
  explicit RigMinutes(const StudyOptions& options) : options_(options) {}

  Result<Rows> table() {
    if (Result<void> ok = begin(); !ok) return std::move(ok).error();
    if (Result<void> ok = add_row("a tape and data sheets", rig_->folder() / "calibration"); !ok)
      return std::move(ok).error();
    int done = 0, sheets = 0;
    for (const Step& step : steps()) {
      if (Result<void> ok = take(step, ++sheets); !ok) return std::move(ok).error();
      options_.progress(++done, static_cast<int>(steps().size()));
    }
    return std::move(rows_);
  }

 private:
  Result<void> begin() {
    auto rig = virtual_rig::RigProcess::start({.programs = options_.programs,
                                               .scene = scene_,
                                               .folder = scratch_.path() / "rig",
                                               .megapixels = options_.megapixels,
                                               .is_bare = true});
    if (!rig) return std::move(rig).error();
    rig_ = std::move(*rig);
    Result<simulator::Scene> scene = simulator::read_scene(scene_);
    if (!scene) return scene.error();
    simulator::resize(scene->camera, options_.megapixels);
    const Result<simulator::SceneRig> exact = simulator::rig_of(*scene);
    if (!exact) return exact.error();
    exact_ = simulator::exact_calibration(*scene, *exact);
    return {};
  }

  /// Lays a thing, has it photographed, and tells what came of it.
  Result<void> take(const Step& step, int number) {
    if (const auto laid = rig_->say(std::string("table ") + step.lays); !laid) return laid.error();
    laid_s_ += kLaying_s;
    const auto began = steady_clock::now();
    if (Result<void> ok = walk({}); !ok) return ok;
    if (step.is_enough) {
      if (Result<void> ok = walk({"--enough"}); !ok) return ok;
    }
    weft_s_ += std::chrono::duration<double>(steady_clock::now() - began).count();
    if (step.after == nullptr) return {};
    const fs::path calibrations = rig_->folder() / "calibrations";
    if (step.result != nullptr)
      return add_row(step.after, calibrations / (std::string("minutes-") + step.result));
    const fs::path partial = scratch_.path() / fmt::format("sheets{}", number);
    const Result<void> fitted =
        weft({"calibrate", "lights", (rig_->folder() / "sets/minutes-sheet").string(), "--from",
              (calibrations / "minutes-response").string(), "-o", partial.string(), "--accept-misfit"});
    return fitted ? add_row(step.after, partial) : fitted;
  }

  Result<void> walk(const std::vector<std::string>& more) const {
    const fs::path things = rig_->folder() / "things";
    std::vector<std::string> arguments = {"calibrate", "all",
                                          "--name",    "minutes",
                                          "--board",   (things / "board.toml").string(),
                                          "--sheet",   (things / "sheet.toml").string(),
                                          "--once"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return weft(arguments);
  }

  Result<void> weft(const std::vector<std::string>& arguments) const {
    const auto process = rig_->weft(arguments, "minutes.log");
    if (!process) return process.error();
    const auto code = (*process)->wait(kPatience_s);
    if (code == 0) return {};
    return Error{ErrorKind::kTryAgain, "weft ended in a way that it should not",
                 fmt::format("{}", arguments[1]), (*process)->said(), "mend that first"};
  }

  Result<void> add_row(const char* after, const fs::path& folder) {
    const Result<Calibration> measured = read_calibration(folder);
    if (!measured) return measured.error();
    if (measured->lights) lights_ = std::get<NearLights>(*measured->lights);
    const auto status = rig_->say("status");
    if (!status) return status.error();
    const calibration::MovementCost cost = calibration::cost_of(*measured->camera, lights_, *exact_.camera,
                                                                std::get<NearLights>(*exact_.lights));
    rows_.push_back({{"after", after},
                     {"photographs", Json::parse(*status).value("shots", 0)},
                     {"minutes", (weft_s_ + laid_s_) / 60},
                     {"mean_deg", cost.mean_deg},
                     {"worst_deg", cost.worst_deg},
                     {"albedo", cost.albedo_factor}});
    return {};
  }

  const StudyOptions& options_;
  const fs::path scene_ = options_.scenes / "rig.toml";
  const TemporaryFolder scratch_;
  std::unique_ptr<virtual_rig::RigProcess> rig_;
  Calibration exact_;
  NearLights lights_;  ///< as far as they are known
  double weft_s_ = 0, laid_s_ = 0;
  Rows rows_;
};

}  // namespace

/// What each further minute at a rig takes away of the error of its normals: a rig that nobody has calibrated
/// is led through `weft calibrate all` by its own virtual camera. A row a step: "after", "photographs" until
/// then, "minutes" (the commands' wall time and laying_s for each thing laid), "mean_deg" and "worst_deg" of
/// normals level and 20 degrees steep over the frame against the exact rig (calibration::cost_of()), "albedo"
/// over the true one. After fewer than five sheets lights are fitted to those there are, beside the walk;
/// that time does not count. Errors: those of the rig's start and of the commands.
Result<Rows> capture_minutes_table(const StudyOptions& options) {
  return RigMinutes(options).table();
}

}  // namespace weft::bench
