// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "material/run/map_set_facts.h"
#include "material/run/map_work.h"

namespace weft::app {

/// Whether the maps are those of a cloth and fit to be put on a material (material/validation). Those that
/// did not pass have a picture of where, and their verdicts are added to the work's. Errors of validate() and
/// of writing pictures.
Result<std::vector<MapCheck>> check_maps(MapWork& work, bool has_measured_black);

}  // namespace weft::app
