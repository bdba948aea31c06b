// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct MinutesOptions {
  std::filesystem::path programs;  ///< folder with weft, weft-camera and weft-virtual-rig
  std::filesystem::path scene = "testdata/scenes/rig.toml";
  double megapixels = 0.25;
  double laying_s = 20;  ///< that a person takes to lay a thing on the table
  std::function<void(int done, int steps)> progress = [](int, int) {};
};

/// What each further minute at a rig takes away of the error of its normals: a rig that nobody has calibrated
/// is led through `weft calibrate all` by its own virtual camera. A row a step: "after", "photographs" until
/// then, "minutes" (the commands' wall time and laying_s for each thing laid), "mean_deg" and "worst_deg" of
/// normals level and 20 degrees steep over the frame against the exact rig (calibration::cost_of()), "albedo"
/// over the true one. After fewer than five sheets lights are fitted to those there are, beside the walk;
/// that time does not count. Errors: those of the rig's start and of the commands.
Result<Rows> capture_minutes_table(const MinutesOptions& options);

}  // namespace weft::bench
