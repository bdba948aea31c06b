// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "core/base/vec.h"
#include "simulator/geometry/sphere.h"
#include "simulator/geometry/surface_point.h"

namespace weft::simulator {

/// An endless rod across the table's centre, sunk into the table like a Sphere; its axis points along
/// `azimuth_deg`, from x towards y.
class Cylinder {
 public:
  Cylinder(double radius_mm, double contact_deg, double azimuth_deg)
      : section_(radius_mm, contact_deg),
        axis_x_(std::cos(radians(azimuth_deg))),
        axis_y_(std::sin(radians(azimuth_deg))) {}

  SurfacePoint at(double x_mm, double y_mm) const {
    const SurfacePoint p = section_.at(axis_x_ * y_mm - axis_y_ * x_mm, 0);
    return {p.height_mm, {-axis_y_ * p.normal.x, axis_x_ * p.normal.x, p.normal.z}, {}, axis_x_, axis_y_};
  }
  HeightRange heights_mm(const Area& area) const { return section_.heights_mm(area); }
  std::optional<Period> period_mm() const { return std::nullopt; }
  double steepest_slope() const { return section_.steepest_slope(); }

 private:
  Sphere section_;
  double axis_x_;
  double axis_y_;
};

}  // namespace weft::simulator
