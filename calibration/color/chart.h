// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "calibration/color/chart_reference.h"
#include "core/base/result.h"
#include "core/image/image.h"

// The 24-patch chart in a picture.

namespace weft::calibration {

/// Outer corners of patches 1, 6, 24 and 19 in pixels: clockwise from the upper left of the upright chart.
/// (0, 0) is the centre of the first pixel.
using ChartCorners = std::array<std::array<double, 2>, 4>;

/// Side of a patch over the distance from one patch to the next, of classic charts and of simulated ones:
/// only the middle of a patch is used, so that it need not be exact.
inline constexpr double kPatchShare = 0.88;

/// Finds the chart by OpenCV's mcc in a linear picture (planes R, G, B; +infinity is full). Its white must be
/// brighter than most of the picture; at least 150 pixels across. kBadData where there is none.
Result<ChartCorners> find_chart(const Image<float>& rgb);

/// What the middle of one patch holds.
struct PatchReading {
  Rgb mean = {};          ///< of what is not full
  Rgb sigma = {};         ///< standard deviation of the mean from pixel noise
  double full_share = 0;  ///< of its pixels, in any channel
  double unevenness = 0;  ///< (brightest - darkest quarter) / mean, green
  std::array<double, 2> centre_px = {};
};

/// Reads the patches of a chart, or of a scale of another number of columns and rows, whose outer corners
/// these are: row by row. kUsage where they do not make a chart in the picture: outside it, not convex,
/// patches under 4 pixels.
Result<std::vector<PatchReading>> read_patches(const Image<float>& rgb, const ChartCorners& corners,
                                               int columns = kChartColumns, int rows = kChartRows);

/// How a chart lies against its corners.
enum class ChartSide { kUpright, kUpsideDown, kMirrored, kNoChart };

/// Compares the logarithms of what was read with the reference, patch by patch, as it is, turned by 180
/// degrees, and mirrored either way; kNoChart where nothing correlates better than 0.8. Patches that are full
/// in part are not looked at.
ChartSide side_of(std::span<const PatchReading> patches, const ChartReference& reference);

}  // namespace weft::calibration
