// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/effects/passes.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"

namespace weft::simulator {

/// What comes out of a list of passes.
enum class Output {
  kCounts,   ///< counts of a mosaic
  kRgb,      ///< the linear RGB that a camera without mosaic, photosites' faults and converter would see
  kSurface,  ///< the cloth alone, as truth: its albedo in linear Rec.709
};

/// The passes that a scene calls for, in order, and the effects it does without. `scene` and `rig` are copied
/// into the passes. kBadData where a shadow would be too long to be traced.
Result<PassList> build_passes(const Scene& scene, const SceneRig& rig, Output output);

}  // namespace weft::simulator
