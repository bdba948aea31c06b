// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Takes light that had entered the cloth elsewhere from all frames: as a person said
/// (SolvePlan::cloth_spread), else as a blade's shadow tells, else as the cloth's own photographs do
/// (solver/gates/told_spread.h). How unsure slopes are by it goes into their sigma. Exact for cloth of one
/// albedo; highlights, which do not enter, come out brighter by the share. What a person or a blade says of
/// less than two pixels is left as it is. A blade that cannot be read is a warning. kUsage where a person or
/// a blade speaks and nothing says how large a pixel is.
Result<void> take_off_spread_light(const Exposures& exposures);

}  // namespace weft::solve
