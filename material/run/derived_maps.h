// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "material/run/map_work.h"

namespace weft::material {

/// What can be derived from a surface.
struct DerivedMap {
  const char* name;
  const char* says;
  Result<void> (*make)(MapWork& work);
};
const std::vector<DerivedMap>& derived_maps();

/// Integrates the slopes, once.
Result<void> find_height(MapWork& work);

/// What the relief hides of the sky, once.
Result<void> find_openness(MapWork& work);

// Each makes the map of its name.
Result<void> make_height(MapWork& work);
Result<void> make_curl(MapWork& work);
Result<void> make_occlusion(MapWork& work);
Result<void> make_cavity(MapWork& work);
Result<void> make_roughness(MapWork& work);
Result<void> make_gloss(MapWork& work);
Result<void> make_mips(MapWork& work);
Result<void> make_detail(MapWork& work);
Result<void> make_opacity(MapWork& work);

}  // namespace weft::material
