// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "bench/capture/board.h"
#include "bench/capture/camera.h"
#include "bench/capture/evidence.h"
#include "bench/capture/fault_matrix.h"
#include "bench/capture/focus.h"
#include "bench/capture/live_view.h"
#include "bench/capture/minutes.h"
#include "bench/capture/scans.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"
#include "capture/rig_devices/rig_devices.h"
#include "core/process.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

struct CaptureArguments {
  std::string part = "scans";  ///< board, camera, live and scans are of a running rig
  fs::path rig;
  int runs = 0;  ///< commands, shots, scans or runs; 0: as many as docs/reliability.md
  fs::path scene = "testdata/scenes/satin.toml";
  double megapixels = 0.2;
  int rigs = 16;
  std::uint64_t seed = 1;
  std::vector<std::string> faults;
  fs::path keep;
};

Result<Rows> measure_matrix(const CaptureArguments& a, app::ProgressLine& line) {
  FaultMatrixOptions options;
  options.programs = program_beside("weft").parent_path();
  options.scene = a.scene;
  options.megapixels = a.megapixels;
  options.runs = a.runs > 0 ? a.runs : 1000;
  options.rigs = a.rigs;
  options.seed = a.seed;
  options.faults = a.faults;
  options.keep = a.keep;
  options.progress = [&](int done, int runs) { line.update("faults", static_cast<double>(done) / runs); };
  const Result<std::vector<FaultTally>> tallies = fault_matrix(options);
  if (!tallies) return tallies.error();
  for (const FaultTally& tally : *tallies) {
    for (const std::string& wrong : tally.wrong) app::note(tally.fault + ": " + wrong);
  }
  return rows_of(*tallies);
}

Result<Rows> measure_rig(const CaptureArguments& a, app::ProgressLine& line) {
  const Result<capture::Rig> rig = capture::read_rig(app::find_rig(a.rig));
  if (!rig) return rig.error();
  if (a.part == "board")
    return capture_board_table({.port = rig->board.port, .commands = a.runs > 0 ? a.runs : 10'000});
  if (a.part == "camera")
    return capture_camera_table(
        {.port = rig->camera.port, .profile = rig->camera.profile, .shots = a.runs > 0 ? a.runs : 10});
  if (a.part == "live") {
    return capture_live_view_table(
        {.rig = *rig, .open = capture::open_devices, .rounds = a.runs > 0 ? a.runs : 5});
  }
  const int scans = a.runs > 0 ? a.runs : 3;
  return capture_scans_table(
      {.rig = *rig,
       .open = capture::open_devices,
       .scans = scans,
       .stop = app::stop_on_signal(),
       .progress = [&](int done) { line.update("scans", static_cast<double>(done) / scans); }});
}

Result<Rows> measure_evidence(app::ProgressLine& line) {
  return capture_evidence_table({.scenes = "testdata/scenes", .progress = [&](int done, int scenes) {
                                   line.update("evidence", static_cast<double>(done) / scenes);
                                 }});
}

Result<Rows> measure_focus(const CaptureArguments& a, app::ProgressLine& line) {
  FocusOptions options;
  options.scenes = "testdata/scenes";
  if (a.runs > 1) options.repeats = a.runs;
  options.progress = [&](int done, int steps) { line.update("focus", static_cast<double>(done) / steps); };
  return capture_focus_table(options);
}

Result<Rows> measure_minutes(app::ProgressLine& line) {
  MinutesOptions options;
  options.programs = program_beside("weft").parent_path();
  options.progress = [&](int done, int steps) { line.update("minutes", static_cast<double>(done) / steps); };
  return capture_minutes_table(options);
}

Result<Rows> measure(const CaptureArguments& a, bool quiet) {
  app::ProgressLine line(quiet);
  if (a.part == "minutes") return measure_minutes(line);
  if (a.part == "focus") return measure_focus(a, line);
  if (a.part == "evidence") return measure_evidence(line);
  return a.part == "faults" ? measure_matrix(a, line) : measure_rig(a, line);
}

app::Run add_capture(app::Options& options) {
  const auto a = std::make_shared<CaptureArguments>();
  options
      .add("--part", &a->part,
           "board, camera, live, scans: of the rig of --rig; faults: the fault matrix, on virtual rigs that "
           "it starts; evidence: what light tells of LEDs; focus: how well a photograph tells blur; "
           "minutes: what each further minute of calibrating takes away")
      .one_of({"board", "camera", "live", "scans", "faults", "evidence", "focus", "minutes"})
      .shows_default();
  options.add("--rig", &a->rig, "Rig file; default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
  options.add("--runs", &a->runs, "Commands, shots, scans or runs; 0 is as many as docs/reliability.md")
      .in_range(0, 1000000);
  options.add("--scene", &a->scene, "Scene of the fault matrix").shows_default();
  options.add("--megapixels", &a->megapixels, "Size of its frames, millions of pixels")
      .in_range(0.05, 200.0)
      .shows_default();
  options.add("--rigs", &a->rigs, "Rigs side by side").in_range(1, 64).shows_default();
  options.add("--seed", &a->seed, "Of shots and moments").shows_default();
  options.add("--fault", &a->faults, "These faults alone, by their names in the table");
  options.add("--keep", &a->keep, "Folder for the sessions and logs of runs that went wrong");
  return [a](const app::CommonArguments& common) { return print_rows(measure(*a, common.quiet), common); };
}

}  // namespace

app::Verb capture_verb() {
  return {"capture", "Scans: their speed, and what faults do to them", add_capture};
}

}  // namespace weft::bench
