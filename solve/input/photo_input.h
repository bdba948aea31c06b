// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/image_io/linear_image.h"
#include "solve/input/light_axes.h"
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

/// Whether directions of lights are those of the picture as it is shown, by its tag Orientation, or as its
/// rows are stored.
enum class PictureOrientation { kShown, kStored };
inline constexpr std::array<const char*, 2> kPictureOrientationNames = {"shown", "stored"};

/// Where photographs under distant lights and their lights are: `folder`, `light_file` or both are named.
struct PhotoOptions {
  /// Has photographs and perhaps a mask (solve/input/photo_mask.h). Without `light_file` its lights are in it
  /// or above (solve/input/light_list.h).
  std::filesystem::path folder;
  /// What holds the lights; without `folder` also where photographs are, beside it or as it says.
  std::filesystem::path light_file;
  bool skips_missing = false;  ///< leaves out lights whose photograph is not there
  Transfer transfer = Transfer::kAuto;
  PictureOrientation orientation = PictureOrientation::kShown;
  LightFlip flip = LightFlip::kNone;
  std::filesystem::path dark;  ///< the same with all lamps off; empty: none
  double ambient = 0;          ///< light that is in all of them, a share of full scale
  /// How large a pixel is on the cloth; none: not known. With it positions of lights are near lights, in mm.
  std::optional<double> mm_per_pixel = {};
  std::optional<double> fov_deg = {};  ///< of the picture's width; none: seen from far away
  Clipped clipped = Clipped::kMark;
  std::vector<int> lights;  ///< numbers from 1; empty: all
};

/// Lit shots without a rig, each numbered by its place in the list (SolvePlan). kBadData for a layout, a
/// light or a picture that cannot be used, and for fewer than three.
Result<SolvePlan> plan_photos(const PhotoOptions& options);

}  // namespace weft::solve
