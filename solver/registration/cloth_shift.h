// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image.h"

namespace weft::solver {

/// How the cloth of one shot lies against the cloth of the others, in pixels of the frame: x to the right, y
/// down, turned about the frame's centre.
struct ClothShift {
  double dx_px = 0;
  double dy_px = 0;
  double turn = 0;  ///< radians, from x to the right towards up

  struct Displacement {
    double x = 0, y = 0;
  };
  /// Of what lies `x`, `y` pixels right of and below the frame's centre.
  Displacement at(double x, double y) const { return {dx_px + turn * y, dy_px - turn * x}; }
  friend bool operator==(const ClothShift&, const ClothShift&) = default;
};

/// The part of the frame that resampling `tile` looks at; it begins on even pixels. `step` as below.
Rect seen_through(const ClothShift& shift, Rect tile, Size frame, int step);

/// Readings of `tile` with the cloth back where it lies in the other shots: out(p) = source(p + shift(p)), by
/// Lanczos' kernel of three lobes between sites `step` pixels apart - 2 for a mosaic, whose colours are not
/// mixed, 1 for photographs. `source` holds `source_rect` of the frame, at least seen_through(); `out` has
/// (0, 0) at the tile's corner. A displacement by whole steps copies. What touches a reading that cannot be
/// used cannot be used (+infinity); what lies beyond the frame is missing (NaN). The light is taken to be the
/// same at both ends of the shift: a pixel is a tenth of a millimetre, its LED half a metre away.
///
/// The displacement is constant along runs of kRowGroup pixels from column 0 on, so that a value depends on
/// its place alone, never on the tile.
void resample(View<const float> source, Rect source_rect, const ClothShift& shift, Rect tile, Size frame,
              int step, View<float> out);

}  // namespace weft::solver
