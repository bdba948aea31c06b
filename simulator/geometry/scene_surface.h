// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/base/vec.h"
#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/height_map.h"
#include "simulator/geometry/knit.h"
#include "simulator/geometry/sphere.h"
#include "simulator/geometry/surface_point.h"
#include "simulator/geometry/weave.h"

// The shape of the cloth in closed form: height and normal at any point of the table, without a grid.

namespace weft::simulator {

/// A plane through the centre of the table.
class TablePlane {
 public:
  explicit TablePlane(Vec3 normal) : normal_(normal) {}
  SurfacePoint at(double x_mm, double y_mm) const {
    return {-(normal_.x * x_mm + normal_.y * y_mm) / normal_.z, normal_, {}};
  }
  HeightRange heights_mm(const Area& a) const {
    const auto [lowest, highest] =
        std::minmax({at(a.x0_mm, a.y0_mm).height_mm, at(a.x1_mm, a.y0_mm).height_mm,
                     at(a.x0_mm, a.y1_mm).height_mm, at(a.x1_mm, a.y1_mm).height_mm});
    return {lowest, highest};
  }
  std::optional<Period> period_mm() const { return std::nullopt; }
  double steepest_slope() const { return std::hypot(normal_.x, normal_.y) / normal_.z; }

 private:
  Vec3 normal_;
};

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

using BaseSurface = std::variant<TablePlane, Weave, Knit, Sphere, Cylinder, HeightMap>;

/// A surface with folds and waves on it: heights add, and so do slopes.
class Draped {
 public:
  Draped(BaseSurface base, Drape drape);
  SurfacePoint at(double x_mm, double y_mm) const;
  HeightRange heights_mm(const Area& area) const;
  std::optional<Period> period_mm() const { return std::nullopt; }
  double steepest_slope() const;

 private:
  BaseSurface base_;
  Drape drape_;
};

using Surface = std::variant<TablePlane, Weave, Knit, Sphere, Cylinder, HeightMap, Draped>;

/// The surface of settings in range; a height map without heights is a level plane.
Surface surface_of(const GeometrySettings& geometry);

SurfacePoint point_at(const Surface& surface, double x_mm, double y_mm);

/// Bounds of the height over an area.
HeightRange heights_mm(const Surface& surface, const Area& area);

/// Nothing where the surface does not repeat.
std::optional<Period> period_mm(const Surface& surface);

/// An upper bound of |gradient| of the height.
double steepest_slope(const Surface& surface);

}  // namespace weft::simulator
