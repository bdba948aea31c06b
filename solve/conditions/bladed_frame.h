// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"
#include "solver/transport/blade_shadow.h"

namespace weft::solve {

/// What the shot with a blade (SolvePlan::blade), which is there, tells of how the cloth spreads light.
/// `pixel_mm` of the cloth. kBadData where its picture cannot be used, or its LED's is left out.
Result<solver::BladeShadow> read_bladed_frame(const Exposures& exposures, double pixel_mm);

}  // namespace weft::solve
