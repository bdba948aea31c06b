// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace weft::report {

/// A direction above a table, and a value there.
struct SkyPoint {
  double from_axis_deg = 0, azimuth_deg = 0;  ///< angle to the upright axis; from x towards y
  double value = 0;
};

/// Directions seen from below the axis: it is in the middle, x to the right, y up; as far from the middle as
/// from the axis.
struct Hemisphere {
  std::string title, unit;
  std::vector<SkyPoint> values = {};  ///< coloured; what is not finite is left out
  std::vector<SkyPoint> leds = {};    ///< numbered from 1
  std::optional<SkyPoint> best = {};  ///< circled, with its value
};

/// 520 x 600 units. The same drawing gives the same bytes.
std::string hemisphere_svg(const Hemisphere& drawing);

}  // namespace weft::report
