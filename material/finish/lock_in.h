// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"
#include "material/lattice/lattice.h"
#include "material/surface.h"

namespace weft::material {

/// How far a cloth is pulled from its lattice: a point that the lattice puts at X is seen at x with
/// x + d(x) = X. Pixels, x right, y up.
class Displacement {
 public:
  Displacement() = default;
  Displacement(Image<float> field, int step, Size frame);

  /// At a place from the frame's centre; beyond the border that of the border.
  Vec2 at(Vec2 place) const;
  const Image<float>& field() const { return field_; }  ///< 2 planes; a pixel is step() of the frame's wide
  int step() const { return step_; }

 private:
  Image<float> field_;
  int step_ = 1;
  Size frame_;
};

/// The displacement from the phases of the weave's six strongest waves in the slopes, each low-passed by a
/// Gaussian of `sigma_px` (lock-in), by least squares weighted by their amplitudes. Phases are followed from
/// the frame's centre outwards, so that a cloth may be pulled over many yarns; there the displacement is
/// about 0.
Displacement lock_in(const Surface& surface, const Cell& weave, double sigma_px, int threads);

}  // namespace weft::material
