// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "solver/frame_fit/cell_fit.h"
#include "solver/frame_fit/frame_misfit.h"

namespace weft::solver {

/// Light that all photographs have and their dark shot lacks, or the other way round.
struct RoomShare {
  double share = 0;  ///< of a cell's mean reading; below 0: the dark shot has light that they lack
  double alone = 0;  ///< the same if no light has a gain
  double sigma = 0;  ///< of the share, by how parts of the frame differ
  /// The same by how cells that lean differently differ: what shines, and light between yarns, depends on it.
  double by_tilt = 0;
  /// So much may come of shadows, of light between yarns and of highlights.
  double doubt = 0;

  bool is_told() const;
};

/// The share whose light, taken off, lets the readings of each cell fit best: least squares over lit readings
/// with a gain of each light beside it and without, whichever is less, albedo and normal eliminated. Not told
/// of flat things, nor by lights that are all as high over them. Photographs that do not fit say nothing.
/// `noise` is the sigma of an error that noise alone gives, of the brightness.
RoomShare find_room_light(const FrameCells& cells, const CellFit& fit, std::span<const FrameMisfit> misfits,
                          double noise);

}  // namespace weft::solver
