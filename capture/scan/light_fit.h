// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "capture/scan/glance.h"
#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/rig/calibration.h"
#include "core/rig/cloth_pose.h"

namespace weft::capture {

/// The lights of a calibration on the patches of a frame.
struct PatchLights {
  PatchGrid grid;
  GlanceScale scale;
  std::vector<std::vector<Vec3>> leds;  ///< by LED (from 0) and patch: direction times strength
  double reading = 0;      ///< of a white surface that faces an average LED, in its strongest channel
  std::vector<Vec3> room;  ///< by patch: light from straight above, as strong as a LED on average

  /// The calibration has camera and lights. Errors as LightField::make().
  static Result<PatchLights> make(const Calibration& calibration, double cloth_height_mm,
                                  const ClothPose& pose = {});
};

/// What frames say of themselves when each is given the light it may have been taken in.
struct PatchFit {
  /// What is left of the readings once every patch has its own albedo and normal (Lambert) and every frame
  /// its own brightness: mean of their absolute deviations over the mean reading of the patch.
  double misfit = 0;
  std::vector<double> gain;  ///< brightness of each frame, 1 on geometric average
};

/// `light[f]` is what frame f has on each patch, `incident[f]` what falls on it. At least four frames: a
/// patch has three unknowns. Only every `step`-th patch is looked at.
PatchFit fit_light(const std::vector<const std::vector<double>*>& light,
                   const std::vector<const std::vector<Vec3>*>& incident, std::size_t step = 1);

/// What such frames let expect by patch under another light, `of`, by the albedo and normal of each patch
/// alone; NaN where fewer than four of them can be read.
std::vector<double> expected_light(const std::vector<const std::vector<double>*>& light,
                                   const std::vector<const std::vector<Vec3>*>& incident,
                                   const std::vector<Vec3>& of);

}  // namespace weft::capture
