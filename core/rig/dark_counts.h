// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image/raw_frame.h"

namespace weft {

/// Light in a dark shot that is spoken of: of its brighter tenth, a share of full scale.
inline constexpr double kDarkWarns = 0.004;

/// What a frame's file calls black, the mean of its filter cell.
inline double mean_black(const RawFrame& frame) {
  double mean = 0;
  for (const auto& row : frame.black) mean += static_cast<double>(row[0] + row[1]) / 4;
  return mean;
}

/// Where the counts of a dark shot lie.
struct DarkCounts {
  std::array<double, 3> median = {};  ///< red, green, blue
  double spread = 0;                  ///< of the widest channel: nine tenths of its counts lie so far apart
};

DarkCounts dark_counts(const RawFrame& dark);

}  // namespace weft
