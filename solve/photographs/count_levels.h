// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

namespace weft::solve {

struct SettledLevels {
  std::vector<std::string> said;  ///< a sentence for each thing that was changed
  double scale = 1;               ///< counts of the frames for one of the calibration's
};

/// Makes the levels of a session's mosaics what their counts show them to be, where files say otherwise.
/// `frames`: all of one body, exposure and set of levels, the first `lit` of them lit, the next the dark shot
/// where there is one.
///
/// Black and white: albedo goes by counts over white - black, as it did when the calibration was made. Where
/// the files' differ from those of the calibration (Response::levels), the dark shot, the black level or
/// where the frames stop tells by which power of two their counts differ from the calibration's, and that is
/// taken. Where the calibration does not say its own, a dark shot that lies off the black level by over 1.5
/// percent of the range is black.
///
/// Full: RawFrame::full by the calibration, else by a pile of equal counts in the frames, where that lies
/// below white by over the 2 percent of kSaturatedFrom.
///
/// Errors (kBadData, whose `where` the caller says): levels that are not the calibration's, and nothing that
/// tells how their counts compare; counts far above white.
Result<SettledLevels> settle_levels(std::span<RawFrame> frames, std::size_t lit, bool has_dark,
                                    const std::optional<Response>& response, int threads);

/// What a response says of counts that are so many times those it was measured on.
Response scaled(Response response, double scale);

}  // namespace weft::solve
