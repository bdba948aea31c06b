// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/photographs/photographs.h"

namespace weft::solve {

/// The part of photographs inside `area`, which begins on a whole filter cell, as photographs of their own:
/// to be solved for the clock. Brackets stay behind, and so does the fall of gain over the frame.
Result<Photographs> cut(const Photographs& whole, Rect area);

}  // namespace weft::solve
