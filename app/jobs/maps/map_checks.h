// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/jobs/maps/map_work.h"
#include "core/json_document.h"
#include "core/result.h"
#include "material/validation/validate.h"

namespace weft::app {

/// Whether the maps are those of a cloth and fit to be put on a material (material/validation): a list of
/// {"name", "severity", "number", "limit", "text"}, with the name of a picture of where for those that did
/// not pass, whose verdicts are added to the work's. Errors of validate() and of writing pictures.
Result<Json> check_maps(MapWork& work, bool has_measured_black);

}  // namespace weft::app
