// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/image_io/linear_image.h"
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

/// Where photographs under distant lights are: one of `folder` and `light_file` is named.
struct PhotoOptions {
  /// A folder in the layout of the DiLiGenT benchmark (Shi et al., CVPR 2016): filenames.txt,
  /// light_directions.txt and, where they exist, light_intensities.txt (R G B a line) and a mask
  /// (solve/input/photo_mask.h).
  std::filesystem::path folder;
  /// Or an RTI light file: a count, then one line "file x y z" a photograph.
  std::filesystem::path light_file;
  Transfer transfer = Transfer::kAuto;
  Clipped clipped = Clipped::kMark;
  std::vector<int> lights;  ///< numbers from 1; empty: all
};

/// Lit shots without a rig, each numbered by its place in the list (SolvePlan). kBadData for a layout, a
/// light or a picture that cannot be used, and for fewer than three.
Result<SolvePlan> plan_photos(const PhotoOptions& options);

}  // namespace weft::solve
