// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/image_io/linear_image.h"
#include "core/rig/photo_reading.h"
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

/// Where photographs under distant lights and their lights are: `folder`, `light_file` or both are named.
struct PhotoOptions {
  /// Has photographs and perhaps a mask (solve/input/photo_mask.h). Without `light_file` its lights are in it
  /// or above (solve/input/light_list.h).
  std::filesystem::path folder;
  /// What holds the lights; without `folder` also where photographs are, beside it or as it says.
  std::filesystem::path light_file;
  bool skips_missing = false;  ///< leaves out lights whose photograph is not there
  PhotoReading reading;
  std::filesystem::path dark;  ///< the same with all lamps off; empty: dark.* or ambient.* of the folder
  std::filesystem::path mask;  ///< where the cloth is; empty: that of `folder`, if it has one
  Clipped clipped = Clipped::kMark;
  std::vector<int> lights;  ///< numbers from 1; empty: all
};

/// Lit shots without a rig, each numbered by its place in the list (SolvePlan). kBadData for a layout, a
/// light or a picture that cannot be used, and for fewer than three.
Result<SolvePlan> plan_photos(const PhotoOptions& options);

}  // namespace weft::solve
