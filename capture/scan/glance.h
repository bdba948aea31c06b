// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

namespace weft::capture {

/// Square patches spread evenly over a frame, at most 48 x 36 of them, each a third of the way to the next
/// wide: small enough to show yarns where the picture does, many enough to show how light falls.
struct PatchGrid {
  Size frame;
  int columns = 0, rows = 0;
  int side = 0;  ///< photosites, even

  static PatchGrid over(Size frame);
  int count() const { return columns * rows; }
  Rect patch(int i) const;
};

/// How raw counts become light for evidence.
struct GlanceScale {
  std::array<std::array<double, 2>, 3> linearity = {};  ///< of core's Response
  std::array<double, 3> weight_rgb = {1, 1, 1};         ///< makes the channels of the rig's LEDs alike
};

/// The light on each patch: the weighted mean of its channels as share of the way from black to white, NaN
/// where a photosite is full.
std::vector<double> glance_at(const RawFrame& frame, const PatchGrid& grid, const GlanceScale& scale);

}  // namespace weft::capture
