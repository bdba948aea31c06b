// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace weft::calibration {

/// A marker as it is printed, square by square with its black border: rows from the top, true is black.
/// kUsage for an id that the dictionary does not have; kBadData where there is no such dictionary.
Result<std::vector<std::vector<bool>>> marker_squares(const std::string& dictionary, int id);

}  // namespace weft::calibration
