// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/result.h"
#include "simulator/effects/halos.h"
#include "simulator/scene/rig.h"
#include "simulator/transport/height_mesh.h"
#include "simulator/transport/shadows.h"

namespace weft::bench {

/// A square of cloth of the deep family, ready for rays.
struct TracedPatch {
  simulator::Scene scene;
  simulator::Halos halos;
  Rect pixels;
  simulator::HeightMesh mesh;  ///< over the pixels and all that their rays may meet
  std::vector<Vec3> normals;   ///< by vertex
  simulator::SphereLight led;  ///< 62 degrees from the zenith, 600 mm away, radius 12 mm
};
Result<TracedPatch> traced_patch(int side_px);

}  // namespace weft::bench
