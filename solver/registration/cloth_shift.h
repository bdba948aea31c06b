// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace weft::solver
