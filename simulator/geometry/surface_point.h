// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/vec.h"

// What every shape of cloth says about a point of the table, and about itself as a whole.

namespace weft::simulator {

/// One yarn of the cloth. Warp yarns lie along y and are numbered by x, weft yarns along x, numbered by y;
/// the yarns of a knit are its courses, numbered by y like a weft.
struct Yarn {
  bool is_weft = false;
  std::int64_t index = 0;
};

/// What the camera sees of the cloth at a point of the table.
struct SurfacePoint {
  double height_mm = 0;  ///< above the plane cloth_height_mm, towards the camera
  Vec3 normal = {0, 0, 1};
  Yarn yarn = {};
  double along_x =
      1;  ///< the yarn's direction seen from above, of any length but 0; x where there is no yarn
  double along_y = 0;
};

/// The yarn's direction in the surface: unit, perpendicular to the normal.
inline Vec3 tangent_of(const SurfacePoint& p) {
  const Vec3& n = p.normal;
  return normalized({p.along_x * n.z, p.along_y * n.z, -(p.along_x * n.x + p.along_y * n.y)});
}

/// The unit normal of a height with these derivatives.
inline Vec3 normal_of_slopes(double slope_x, double slope_y) {
  const double z = 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  return {-slope_x * z, -slope_y * z, z};
}

/// A rectangle of the table.
struct Area {
  double x0_mm = 0, y0_mm = 0, x1_mm = 0, y1_mm = 0;
};

/// Bounds of the height: no point is outside; none need touch them.
struct HeightRange {
  double lowest_mm = 0;
  double highest_mm = 0;
};

/// The least shifts along x and along y that leave the surface unchanged.
struct Period {
  double x_mm = 0;
  double y_mm = 0;
};

}  // namespace weft::simulator
