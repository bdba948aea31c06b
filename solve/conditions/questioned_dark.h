// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Asks mosaics whether their dark shot was taken in their light: one that is lit while they are not is set
/// aside, and light that they have and it lacks, or the other way round, is taken off and told, by the share
/// of their mean reading that lets them fit best (solver/frame_fit/room_light.h).
Result<void> question_dark(const Exposures& exposures);

}  // namespace weft::solve
