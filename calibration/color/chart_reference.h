// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "core/image/color_spaces.h"

namespace weft::calibration {

inline constexpr int kChartColumns = 6, kChartRows = 4, kChartPatches = 24;

/// Colours of a 24-patch chart in linear Rec.709, by rows from the upper left (dark skin) to black.
using ChartReference = std::array<Rgb, kChartPatches>;

/// The classic chart as its maker publishes it (X-Rite, "New color specifications for ColorChecker SG and
/// Classic charts": L*a*b* under D50, 2 degrees): editions made from November 2014 on, and before.
ChartReference published_chart();
ChartReference published_chart_before_2014();

/// "dark skin" for 0.
std::string_view patch_name(int patch);

}  // namespace weft::calibration
