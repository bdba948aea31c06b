// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/vec.h"
#include "simulator/geometry/surface_point.h"

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

}  // namespace weft::simulator
