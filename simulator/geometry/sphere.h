// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "core/base/vec.h"
#include "simulator/geometry/surface_point.h"

namespace weft::simulator {

/// A ball sunk into the middle of the level table so far that it meets it with the slope `contact_deg`, below
/// 90 degrees: what is above is a function of x and y. Its height jumps nowhere; its normal does at the rim.
class Sphere {
 public:
  Sphere(double radius_mm, double contact_deg)
      : radius_mm_(radius_mm),
        centre_mm_(-radius_mm * std::cos(radians(contact_deg))),
        rim_mm_(radius_mm * std::sin(radians(contact_deg))) {}

  SurfacePoint at(double x_mm, double y_mm) const {
    const double off_axis2 = x_mm * x_mm + y_mm * y_mm;
    if (off_axis2 >= rim_mm_ * rim_mm_) return {};
    const double z = std::sqrt(radius_mm_ * radius_mm_ - off_axis2);
    return {centre_mm_ + z, {x_mm / radius_mm_, y_mm / radius_mm_, z / radius_mm_}};
  }
  HeightRange heights_mm(const Area&) const { return {0, centre_mm_ + radius_mm_}; }
  std::optional<Period> period_mm() const { return std::nullopt; }
  double steepest_slope() const { return rim_mm_ / -centre_mm_; }

  double rim_mm() const { return rim_mm_; }        ///< radius of the circle where it meets the table
  double centre_mm() const { return centre_mm_; }  ///< height of the centre: below the table

 private:
  double radius_mm_;
  double centre_mm_;
  double rim_mm_;
};

}  // namespace weft::simulator
