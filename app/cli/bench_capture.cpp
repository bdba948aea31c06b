// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "app/cli/bench_rows.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_devices.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "bench/capture/board.h"
#include "bench/capture/camera.h"
#include "bench/capture/fault_matrix.h"
#include "bench/capture/http.h"
#include "bench/capture/scans.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

Result<bench::Rows> measure_matrix(const BenchCaptureArguments& a, ProgressLine& line) {
  std::error_code failed;
  bench::FaultMatrixOptions options;
  options.programs = fs::read_symlink("/proc/self/exe", failed).parent_path();
  options.scene = a.scene;
  options.megapixels = a.megapixels;
  options.runs = a.runs > 0 ? a.runs : 1000;
  options.rigs = a.rigs;
  options.seed = a.seed;
  options.faults = a.faults;
  options.keep = a.keep;
  options.progress = [&](int done, int runs) { line.update("faults", static_cast<double>(done) / runs); };
  const Result<std::vector<bench::FaultTally>> tallies = bench::fault_matrix(options);
  if (!tallies) return tallies.error();
  for (const bench::FaultTally& tally : *tallies) {
    for (const std::string& wrong : tally.wrong) note(tally.fault + ": " + wrong);
  }
  return bench::rows_of(*tallies);
}

Result<bench::Rows> measure_rig(const BenchCaptureArguments& a, ProgressLine& line) {
  const Result<capture::Rig> rig = capture::read_rig(find_rig(a.rig));
  if (!rig) return rig.error();
  if (a.part == "board")
    return bench::capture_board_table({.port = rig->board.port, .commands = a.runs > 0 ? a.runs : 10'000});
  if (a.part == "camera")
    return bench::capture_camera_table(
        {.port = rig->camera.port, .profile = rig->camera.profile, .shots = a.runs > 0 ? a.runs : 10});
  const int scans = a.runs > 0 ? a.runs : 3;
  return bench::capture_scans_table(
      {.rig = *rig,
       .open = open_devices,
       .scans = scans,
       .stop = stop_on_signal(),
       .progress = [&](int done) { line.update("scans", static_cast<double>(done) / scans); }});
}

}  // namespace

Result<int> run_bench_capture(const BenchCaptureArguments& arguments, const CommonArguments& common) {
  const auto measured = [&] {
    ProgressLine line(common.quiet);
    if (arguments.part == "http")
      return bench::capture_http_table(
          {.requests = arguments.runs > 0 ? arguments.runs : 200, .seed = arguments.seed});
    return arguments.part == "faults" ? measure_matrix(arguments, line) : measure_rig(arguments, line);
  };
  return print_rows(measured(), common);
}

}  // namespace weft::app
