// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "app/cli/options.h"
#include "bench/calibration/camera.h"
#include "bench/calibration/color.h"
#include "bench/calibration/degenerate.h"
#include "bench/calibration/end_to_end.h"
#include "bench/calibration/grey.h"
#include "bench/calibration/lights.h"
#include "bench/calibration/moved.h"
#include "bench/calibration/response.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

struct CalibrationArguments {
  std::string part = "camera";
  int seeds = 0;               ///< 0: as many as the part is quoted for
  std::filesystem::path docs;  ///< folder with calibration.md; empty: no picture
};

// Options of a part, with as many seeds as were asked for.
template <typename Options>
Options seeded(const CalibrationArguments& a, int threads) {
  Options options;
  options.threads = threads;
  if (a.seeds > 0) options.seeds = a.seeds;
  return options;
}

// For the docs, photographs are not timed: the picture has none of it.
Result<Rows> measure_lights(const CalibrationArguments& a, int threads) {
  auto options = seeded<CalibrationLightsBenchOptions>(a, threads);
  if (!a.docs.empty()) options.megapixels = 0;
  Result<Rows> rows = calibration_lights_table(options);
  if (!rows || a.docs.empty()) return rows;
  if (Result<void> written = write_calibration_docs(a.docs, *rows); !written)
    return std::move(written).error();
  return rows;
}

Result<Rows> measure(const CalibrationArguments& a, int threads) {
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

app::Run add_calibration(app::Options& options) {
  const auto a = std::make_shared<CalibrationArguments>();
  options.add("--part", &a->part, "camera, response, color, lights, grey, degenerate, moved, end-to-end")
      .one_of({"camera", "response", "color", "lights", "grey", "degenerate", "moved", "end-to-end"})
      .shows_default();
  options.add("--seeds", &a->seeds, "Rigs or noises to average over; 0 is as many as docs/calibration.md")
      .in_range(0, 10000)
      .shows_default();
  options.add("--docs", &a->docs, "With --part lights: folder for pictures/calibration_poses.svg");
  return [a](const app::CommonArguments& common) { return print_rows(measure(*a, common.threads), common); };
}

}  // namespace

app::Verb calibration_verb() {
  return {"calibration", "What calibrating a simulated rig recovers", add_calibration};
}

}  // namespace weft::bench
