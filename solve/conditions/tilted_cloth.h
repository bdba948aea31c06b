// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Lays a cloth level that does not lie flat and tilts the rig about it, so that maps are those of the
/// cloth's own plane. Errors: as LightField::make.
Result<void> lay_level(const Exposures& exposures);

}  // namespace weft::solve
