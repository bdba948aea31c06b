// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::pipeline {

/// Of a cloth that does not lie flat: lays it level and tilts the rig about it, so that maps are those of the
/// cloth's own plane. Errors: as LightField::make.
Result<void> lay_level(const Exposures& exposures);

}  // namespace weft::pipeline
