// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "simulator/transport/height_mesh.h"

namespace weft::simulator {

/// A surface given pixel by pixel.
struct TestSurface {
  Rect area;
  std::vector<Vec3> points_mm;
  std::vector<Vec3> normals;

  HeightMesh mesh() const {
    auto built = HeightMesh::build(area, points_mm);
    EXPECT_TRUE(built) << (built ? "" : built.error().message());
    return *std::move(built);
  }
};

/// `point_of(x, y)` gives the point and the normal of an absolute pixel.
template <typename PointOf>
TestSurface surface_over(Rect area, const PointOf& point_of) {
  TestSurface surface{area, {}, {}};
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const auto [point_mm, normal] = point_of(x, y);
      surface.points_mm.push_back(point_mm);
      surface.normals.push_back(normal);
    }
  }
  return surface;
}

/// Like a weave with a period of 16 pixels of 0.05 mm, far off the rig's centre: crossing ridges, steep
/// (mean slope 37 degrees) and creased where they meet. Columns go along x, rows along -y, a little bent.
inline TestSurface bumpy_surface(Rect area) {
  const auto height_mm = [](double x_mm, double y_mm) {
    const double a = std::cos(x_mm * 2 * kPi / 0.8), b = std::cos(y_mm * 2 * kPi / 0.8);
    return 0.22 * std::max(0.7 * a + 0.3 * a * b, 0.7 * b - 0.3 * a * b);
  };
  return surface_over(area, [&](int x, int y) {
    const double x_mm = 120 + 0.05 * x + 1e-5 * x * y, y_mm = 60 - 0.05 * y;
    constexpr double kStep = 1e-5;
    const Vec3 normal = {height_mm(x_mm - kStep, y_mm) - height_mm(x_mm + kStep, y_mm),
                         height_mm(x_mm, y_mm - kStep) - height_mm(x_mm, y_mm + kStep), 2 * kStep};
    return std::pair{Vec3{x_mm, y_mm, height_mm(x_mm, y_mm)}, normalized(normal)};
  });
}

inline Rect grown(Rect r, int pixels) {
  return {r.x0 - pixels, r.y0 - pixels, r.x1 + pixels, r.y1 + pixels};
}

}  // namespace weft::simulator
