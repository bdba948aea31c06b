// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "bench/capture/capture_studies.h"
#include "bench/capture/fault_matrix.h"
#include "bench/program/studies.h"

namespace weft::bench {
namespace {

Result<Rows> measure_matrix(FaultMatrixOptions matrix, const StudyOptions& options) {
  matrix.programs = options.programs;
  matrix.runs = options.runs;
  matrix.seed = options.seed;
  matrix.progress = options.progress;
  const Result<std::vector<FaultTally>> tallies = fault_matrix(matrix);
  if (!tallies) return tallies.error();
  for (const FaultTally& tally : *tallies) {
    for (const std::string& wrong : tally.wrong) app::note(tally.fault + ": " + wrong);
  }
  return rows_of(*tallies);
}

/// With the rig that a command is told of.
auto of_rig(Result<Rows> (*table)(const StudyOptions&)) {
  return [table](StudyOptions options) {
    options.rig = app::find_rig(options.rig);
    return table(options);
  };
}

Result<Rows> measure_scans(StudyOptions options) {
  options.stop = app::stop_on_signal();
  return of_rig(capture_scans_table)(options);
}

app::Run add_capture(app::Options& options) {
  const auto matrix = std::make_shared<FaultMatrixOptions>();
  matrix->scene = "testdata/scenes/satin.toml";
  const Choice choice = by_part(
      options, {{"scans", "scans by the rig of --rig", measure_scans, {.runs = 3}},
                {"board", "commands to the board of --rig", of_rig(capture_board_table), {.runs = 10'000}},
                {"camera", "photographs by the camera of --rig", of_rig(capture_camera_table), {.runs = 10}},
                {"live", "the finder of the camera of --rig", of_rig(capture_live_view_table), {.runs = 5}},
                {"faults",
                 "the fault matrix, on virtual rigs that it starts",
                 [matrix](const StudyOptions& o) { return measure_matrix(*matrix, o); },
                 {.runs = 1000}},
                {"evidence", "what light tells of LEDs", capture_evidence_table},
                {"focus", "how well a photograph tells blur", capture_focus_table},
                {"minutes",
                 "what each further minute of calibrating takes away",
                 capture_minutes_table,
                 {.megapixels = 0.25}}});
  options.add("--rig", &choice->options.rig,
              "Rig file; default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
  options
      .add("--runs", &choice->options.runs,
           "Commands, shots, scans or runs; 0 is as many as docs/measured/reliability.md")
      .in_range(0, 1000000);
  options.add("--scene", &matrix->scene, "Scene of the fault matrix").shows_default();
  options.add("--megapixels", &matrix->megapixels, "Size of its frames, millions of pixels")
      .in_range(0.05, 200.0)
      .shows_default();
  options.add("--rigs", &matrix->rigs, "Rigs side by side").in_range(1, 64).shows_default();
  options.add("--seed", &choice->options.seed, "Of shots and moments").shows_default();
  options.add("--fault", &matrix->faults, "These faults alone, by their names in the table");
  options.add("--keep", &matrix->keep, "Folder for the sessions and logs of runs that went wrong");
  return run_of(choice);
}

}  // namespace

app::Verb capture_verb() {
  return {"capture", "Scans: their speed, and what faults do to them", add_capture};
}

}  // namespace weft::bench
