// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::calibration {

/// Light over the frame, in parts: means of a picture's green, counts over black of a raw.
std::vector<double> light_by_parts(const RawFrame& frame);
std::vector<double> light_by_parts(View<const float> green);

/// Which of these photographs a dark shot is like, to a tenth of the photograph's mean; nothing where it is
/// like none, as is a dark shot in a room that is not dark.
std::optional<std::size_t> photograph_like(std::span<const double> dark,
                                           std::span<const std::vector<double>> lit);

}  // namespace weft::calibration
