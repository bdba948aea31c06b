// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/result.h"
#include "material/layers/field.h"
#include "material/layers/parameters.h"

// Brings a layer to the grid of what it lies on: at its true size, repeated a whole number of times.

namespace weft::material {

/// How many repeats of a layer lie on a grid.
struct LayerFit {
  double across = 1, down = 1;          ///< repeats over the grid's width and height, above 0
  double left_px = 0, top_px = 0;       ///< of the grid: where the first repeat begins
  int quarter_turns = 0;                ///< counter-clockwise, of the layer before it is repeated
  double stretch_x = 1, stretch_y = 1;  ///< its width and height on the grid over its own, after turning
  bool wraps = true;                    ///< goes on at its opposite border; else its border goes on outside
};

/// What a layer's size is taken by.
struct FitSizes {
  std::array<double, 2> layer_mm = {}, below_mm = {};  ///< above 0
  std::array<double, 2> repeat_mm = {};  ///< what a repeat is to cover, after turning; 0: its own size
  std::array<double, 2> offset_mm = {};  ///< from the left upper corner, to the right and down
  int quarter_turns = 0;
  Size below;  ///< pixels
};

/// Repeats that are within half a percent of whole ones become whole, and the layer is stretched so far.
/// kUsage where they are not, unless `repeat_mm` is given and what is below is no tile (`below_is_tile`): a
/// border then cuts the layer.
Result<LayerFit> fit_layer(const FitSizes& sizes, bool below_is_tile);

/// The field on a grid of `size`, by linear interpolation where it has fewer pixels than the grid and by a
/// tent as wide as a pixel of the grid's where it has more. Slopes are divided by the stretch, so that they
/// stay those of the same heights; turned slopes and axes point where the turned cloth does. A layer of the
/// grid's own pixels comes back bit for bit. The same bytes for any number of threads.
ParameterField fitted(const ParameterField& field, BlendSpace space, const LayerFit& fit, Size size,
                      int threads);

}  // namespace weft::material
