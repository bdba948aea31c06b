// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "core/image_io/linear_image.h"
#include "core/rig/lights.h"
#include "core/solve/solve_parts.h"
#include "solve/photographs/photographs.h"

namespace weft::app {

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

/// Photographs under distant lights that have been looked at but not read.
struct PhotoPlan {
  std::vector<std::filesystem::path> files;
  DistantLights lights;
  std::filesystem::path mask;  ///< empty: every pixel counts
  Size size;
  Transfer transfer = Transfer::kLinear;  ///< kAuto: files differ, and each is taken by its own kind
  Clipped clipped = Clipped::kMark;
  SolveInput input;  ///< for solve.json, and what the id of the solve is made of
};

Result<PhotoPlan> plan_photos(const PhotoOptions& options);
/// Reads the photographs; readings outside the mask are missing.
Result<pipeline::Photographs> load_photos(const PhotoPlan& plan, const JobContext& context);

}  // namespace weft::app
