// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/image/image.h"
#include "material/vec2.h"

namespace weft::material {

/// Where each pixel of a new grid lies in an old one: places every `step` pixels, cubic between them. Pixels
/// from the centre of the old picture, x right, y up.
class Lookup {
 public:
  Lookup() = default;
  /// Room for a new grid of this size; set() gives the places.
  Lookup(Size grid, int step);

  Size grid() const { return grid_; }
  int step() const { return step_; }
  /// Nodes are at columns (i - 1) step and rows (j - 1) step.
  Size nodes() const { return {places_.width(), places_.height()}; }
  Vec2 node(int i, int j) const { return {places_(i, j, 0), places_(i, j, 1)}; }
  void set(int i, int j, Vec2 place);

  /// A place, and how it changes from one column to the next and from one row to the next.
  struct Place {
    Vec2 at, by_column, by_row;
  };
  Place at(double column, double row) const;

 private:
  Size grid_;
  int step_ = 1;
  Image<double> places_;
};

}  // namespace weft::material
