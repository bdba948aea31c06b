// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/input/photo_input.h"
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

/// Looks at the headers of the photographs of a plan: their size, how they follow light, how they are to be
/// shown, how they were exposed, and what their digests are. What nothing but custom tells goes into
/// `SolvePlan::assumed`. Photographs that were exposed differently are divided by their exposure, unless
/// the strengths of their lights are given. kBadData for what has no meaning, and for photographs that differ
/// in size, kind, orientation or data window.
Result<void> look_at_pictures(const PhotoOptions& options, SolvePlan& plan);

}  // namespace weft::solve
