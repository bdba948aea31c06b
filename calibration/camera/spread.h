// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/pose.h"
#include "core/image/raw_frame.h"
#include "core/rig/camera.h"
#include "core/rig/point_spread.h"

namespace weft::calibration {

/// An edge behind lens and photosite, as the photosites of one colour see it.
struct SeenEdge {
  double at_px = 0;     ///< how far it lies from where the camera predicts it
  double sigma_px = 0;  ///< of the lens's spread
};

/// The edge between two squares of a board.
struct BoardEdge {
  PixelPoint middle;                            ///< as the camera predicts it
  PixelPoint across;                            ///< unit vector along which SeenEdge::at_px counts
  std::array<std::optional<SeenEdge>, 3> seen;  ///< by colour
};

/// The edges between a board's squares as each colour shows them (slanted edges, as in ISO 12233). Where an
/// edge lies follows from the fitted camera. The photosites of one colour beside it, by their distance from
/// it, show the edge behind lens and photosite: levels, place and a Gaussian over the photosite's square are
/// fitted to each edge. Edges are left out that have no clear margin of 2 pixels, less than a tenth of full
/// scale of contrast or saturated photosites.
std::vector<BoardEdge> find_edges(const RawFrame& frame, const CameraModel& camera,
                                  const Pose& rig_from_board, const Board& board);

/// How wide the lens spreads a point: the median over the edges of all photographs; nothing where some colour
/// was seen at fewer than 40.
std::optional<PointSpread> median_spread(std::span<const BoardEdge> edges);

}  // namespace weft::calibration
