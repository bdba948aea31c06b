// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "simulator/scene.h"

// The shape of the cloth in closed form: height and normal at any point of the table, periodic, without a
// grid.

namespace weft::simulator {

/// One yarn of the cloth. Warp yarns lie along y and are numbered by x, weft yarns along x, numbered by y.
struct Yarn {
  bool is_weft = false;
  std::int64_t index = 0;
};

/// What the camera sees of the cloth at a point of the table.
struct SurfacePoint {
  double height_mm = 0;  ///< above the plane cloth_height_mm, towards the camera
  Vec3 normal = {0, 0, 1};
  Yarn yarn;
};

/// How warp and weft cross: warp yarn i lies over weft yarn j where (j - step * i) mod period() < over.
struct Draft {
  int over = 1;
  int under = 1;
  int step = 1;
  int period() const { return over + under; }
};

Draft draft_of(const GeometrySettings& geometry);

/// Whether the highest yarn stays below its neighbours' crests at their axes, which is what keeps the height
/// of a Weave without jumps.
bool yarns_stay_beside_their_neighbours(const GeometrySettings& geometry);

/// A plane through the centre of the table.
class Plane {
 public:
  explicit Plane(Vec3 normal) : normal_(normal) {}
  SurfacePoint at(double x_mm, double y_mm) const {
    return {-(normal_.x * x_mm + normal_.y * y_mm) / normal_.z, normal_, {}};
  }

 private:
  Vec3 normal_;
};

/// Round warp and weft yarns that go over and under each other; the surface is the highest of them at each
/// point. A yarn's axis rises and falls between crossings as 3 t^2 - 2 t^3. Its cross-section is a circular
/// arc, up to half a pitch from the axis, where the slope is tan(flank_deg), and straight beyond: so the
/// height has creases where yarns meet but no jumps. Height 0 is the crest of a yarn half-way between over
/// and under. With twist_relief, the plies of Z-twisted yarns show as ridges at 45 degrees, two from crossing
/// to crossing.
class Weave {
 public:
  explicit Weave(const GeometrySettings& geometry);
  SurfacePoint at(double x_mm, double y_mm) const;
  double period_x_mm() const { return period_ * warp_.pitch_mm; }
  double period_y_mm() const { return period_ * weft_.pitch_mm; }

 private:
  /// Yarns of one direction.
  struct Set {
    double pitch_mm;
    double radius_mm;  ///< of the arc
  };

  int period_;
  double crimp_mm_;
  double twist_mm_;
  double flank_slope_;
  Set warp_;
  Set weft_;
  std::vector<double> warp_side_;  ///< [i * period + j]: 1 where warp yarn i lies over weft yarn j, else -1
};

using Surface = std::variant<Plane, Weave>;
Surface surface_of(const GeometrySettings& geometry);

}  // namespace weft::simulator
