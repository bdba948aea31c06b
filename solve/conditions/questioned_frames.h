// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Rows of raw frames whose counts are one and below black are no readings: a transfer broke off. They are
/// told.
Result<void> hide_unread_rows(const Exposures& exposures);

/// Asks of each photograph whether it fits the others (solver/frame_fit): light that flickers along rows is
/// evened out, a part of a frame that does not fit is not read, and a frame that fits nothing is left out.
/// Each is told with what it would have cost. Two frames that show each other's LEDs stay in for the
/// diagnosis. Errors: those of leave_out().
Result<void> question_frames(const Exposures& exposures);

}  // namespace weft::solve
