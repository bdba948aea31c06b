// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Finds where photographs that somebody developed stop below the full scale of their files, as counts of 12
/// bits in files of 16 do: where many more samples of several photographs have the very largest value of all
/// than any value below it. Those are marked as saturated, and it is said.
Result<void> find_full_scale(const Exposures& exposures);

}  // namespace weft::solve
