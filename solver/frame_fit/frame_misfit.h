// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/image/image.h"
#include "solver/frame_fit/cell_fit.h"

namespace weft::solver {

/// How one photograph fits the others.
struct FrameMisfit {
  double gain = 1;     ///< its light over what the others predict, median over lit cells
  double missed = 0;   ///< with that gain: median of |error|, of the brightness
  double typical = 0;  ///< the same of the other photographs, their median
  /// Cells that are too dark, though they fit elsewhere, and the share of the frame that they are.
  std::optional<Rect> part;
  double part_share = 0;
  double part_light = 1;  ///< in that part, of what the others predict
  /// Not said where it fits a light that comes from elsewhere: then the lights are not what they are said to
  /// be, and the frame is right; nor where all of the cloth may lie in its highlight (tilt_law.h).
  bool fits_nothing = false;
  /// The photograph that shows what this one does, if there is one.
  std::optional<std::size_t> same_as;
  std::optional<std::size_t> lit_by;  ///< the light whose photograph it would be
  bool is_turned = false;             ///< by half, and would fit if it were turned back

  bool is_wrong() const { return fits_nothing || part; }
};

/// A photograph that fits nothing is missed by this share at least, and by so many times as much as the
/// others are: the second where these are missed by over 0.03, as cloth that shines is. Nearer than that a
/// copy is told where it is missed by more than the photograph that it shows and is far more like it than
/// others are like any; a turned one where what is predicted fits it better turned.
inline constexpr double kMissedFrom = 0.03, kMissedTimes = 2.2, kMissedTimesOfGloss = 4;

/// Each photograph's. Nothing is said of fewer than six.
std::vector<FrameMisfit> frame_misfits(const FrameCells& cells, const CellFit& fit, int threads);

}  // namespace weft::solver
