// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "simulator/geometry/cylinder.h"
#include "simulator/geometry/drape.h"
#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/height_map.h"
#include "simulator/geometry/knit.h"
#include "simulator/geometry/sphere.h"
#include "simulator/geometry/surface_point.h"
#include "simulator/geometry/table_plane.h"
#include "simulator/geometry/weave.h"

// The shape of the cloth in closed form: height and normal at any point of the table, without a grid.

namespace weft::simulator {

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
