// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/pose.h"
#include "core/camera.h"
#include "core/point_spread.h"
#include "core/raw_frame.h"

namespace weft::calibration {

/// Standard deviations of the spread at each edge of a board, by colour.
using EdgeSpreads = std::array<std::vector<double>, 3>;

/// How wide the lens spreads a point, from the edges between a board's squares (slanted edges, as in ISO
/// 12233). Where an edge lies follows from the fitted camera. The photosites of one colour beside it, by
/// their distance from it, show the edge behind lens and photosite: levels, place and a Gaussian over the
/// photosite's square are fitted to each edge. Edges are left out that have no clear margin of 2 pixels, less
/// than a tenth of full scale of contrast or saturated photosites.
EdgeSpreads edge_spreads(const RawFrame& frame, const CameraModel& camera, const Pose& rig_from_board,
                         const Board& board);

/// The median over the edges of all photographs; nothing where some colour was seen at fewer than 40.
std::optional<PointSpread> median_spread(std::span<const EdgeSpreads> photographs);

}  // namespace weft::calibration
