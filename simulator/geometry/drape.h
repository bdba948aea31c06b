// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/surface_point.h"

namespace weft::simulator {

/// Folds and slow waves of a cloth that does not lie flat.
class Drape {
 public:
  /// What the drape adds to a surface.
  struct Lift {
    double height_mm = 0;
    double slope_x = 0;
    double slope_y = 0;
  };

  Drape(std::span<const Fold> folds, std::span<const Wave> waves);
  Lift at(double x_mm, double y_mm) const;
  HeightRange heights_mm() const;
  double steepest_slope() const;

 private:
  /// amplitude sin(phase) where sharpness is 0, else amplitude exp(sharpness (cos(phase) - 1)), with
  /// phase = kx x + ky y + start.
  struct Ridges {
    double amplitude_mm;
    double sharpness;
    double kx, ky;
    double start;
  };
  std::vector<Ridges> ridges_;
};

}  // namespace weft::simulator
