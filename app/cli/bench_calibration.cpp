// SPDX-License-Identifier: Apache-2.0
#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"
#include "bench/calibration/camera.h"
#include "bench/calibration/color.h"
#include "bench/calibration/degenerate.h"
#include "bench/calibration/end_to_end.h"
#include "bench/calibration/grey.h"
#include "bench/calibration/lights.h"
#include "bench/calibration/moved.h"
#include "bench/calibration/response.h"

namespace weft::app {
namespace {

// Options of a part, with as many seeds as were asked for.
template <typename Options>
Options seeded(const BenchCalibrationArguments& a, int threads) {
  Options options;
  options.threads = threads;
  if (a.seeds > 0) options.seeds = a.seeds;
  return options;
}

// For the docs, photographs are not timed: the picture has none of it.
Result<bench::Rows> measure_lights(const BenchCalibrationArguments& a, int threads) {
  auto options = seeded<bench::CalibrationLightsBenchOptions>(a, threads);
  if (!a.docs.empty()) options.megapixels = 0;
  Result<bench::Rows> rows = calibration_lights_table(options);
  if (!rows || a.docs.empty()) return rows;
  if (Result<void> written = bench::write_calibration_docs(a.docs, *rows); !written)
    return std::move(written).error();
  return rows;
}

Result<bench::Rows> measure(const BenchCalibrationArguments& a, int threads) {
  using namespace bench;
  if (!a.docs.empty() && a.part != "lights") {
    return Error{ErrorKind::kUsage, "part has no pictures", "--docs", "only the part lights makes one",
                 "give --part lights, or leave --docs out"};
  }
  if (a.part == "camera") return calibration_camera_table(seeded<CalibrationCameraBenchOptions>(a, threads));
  if (a.part == "response")
    return calibration_response_table(seeded<CalibrationResponseBenchOptions>(a, threads));
  if (a.part == "color") {
    CalibrationColorBenchOptions options;
    options.threads = threads;
    return calibration_color_table(options);
  }
  if (a.part == "lights") return measure_lights(a, threads);
  if (a.part == "grey") return calibration_grey_table(seeded<CalibrationGreyBenchOptions>(a, threads));
  if (a.part == "moved") return calibration_moved_table(seeded<CalibrationMovedBenchOptions>(a, threads));
  if (a.part == "degenerate")
    return calibration_degenerate_table(seeded<CalibrationDegenerateBenchOptions>(a, threads));
  CalibrationEndToEndBenchOptions options;
  options.threads = threads;
  return calibration_end_to_end_table(options);
}

}  // namespace

Result<int> run_bench_calibration(const BenchCalibrationArguments& arguments, const CommonArguments& common) {
  return print_rows(measure(arguments, common.threads), common);
}

}  // namespace weft::app
