// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/image/raw_frame.h"

namespace weft {

/// How bright the four sites of the filter cell are beside one another: [y & 1][x & 1], log of the light over
/// the cell's geometric mean, medians over cells that are neither dark nor full.
using SiteLight = std::array<std::array<double, 2>, 2>;

/// Nothing where fewer than 1000 cells say it.
std::optional<SiteLight> site_light(const RawFrame& frame);

/// How the filters of a mosaic lie against the pattern that its file names.
enum class FilterShift { kNone, kRow, kColumn, kRowOrColumn };

/// Tells it of each mosaic of one body by its picture. One that lies a row or a column off against the others
/// has their four sites in other places. All of them lie so (kRowOrColumn) where the two greens differ by
/// over a tenth, and red and blue by less than a quarter of that: those are the greens. Where all four sites
/// are alike nothing is told, and a lamp of another colour moves red and blue, but never one green alone.
std::vector<FilterShift> filter_shifts(std::span<const std::optional<SiteLight>> mosaics,
                                       const CfaPattern& cfa);

}  // namespace weft
