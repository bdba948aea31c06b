// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Says which share of the light is a veil that the lens throws over the frame. Readings come without it
/// (Mosaics::veils).
Result<void> tell_veil(const Exposures& exposures);

}  // namespace weft::solve
