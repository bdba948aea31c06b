// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Takes light that had entered the cloth elsewhere from all frames, where a person said how the cloth
/// spreads it (SolvePlan::cloth_spread), else where a blade's shadow tells. Exact for cloth of one albedo;
/// highlights, which do not enter, come out brighter by the share. Where it leaves less than two pixels away
/// it is left, with a warning. A blade that cannot be read is a warning. kUsage where nothing says how large
/// a pixel is.
Result<void> take_off_spread_light(const Exposures& exposures);

}  // namespace weft::solve
