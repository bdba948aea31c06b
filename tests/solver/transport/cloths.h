// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "solver/transport/light_directions.h"
#include "solver/transport/relief.h"

namespace weft::solver {

inline constexpr double kPitchMm = 0.05;

/// Heights and normals given pixel by pixel.
struct TestCloth {
  Image<float> height_mm, normal;

  Rect pixels() const { return {0, 0, height_mm.width(), height_mm.height()}; }
  Relief relief() const {
    const auto made = Relief::of(height_mm.plane(), kPitchMm);
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    return *made;
  }
  Normals normals_of(Rect tile) const {
    return {normal.plane(0).crop(tile), normal.plane(1).crop(tile), normal.plane(2).crop(tile)};
  }
};

/// `at(x, y)` gives the height in pixels and the normal of a pixel, whose place in the rig frame is (x, -y).
template <typename At>
TestCloth cloth_over(Size size, const At& at) {
  TestCloth cloth = {Image<float>(size), Image<float>(size, 3)};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::pair<double, Vec3> point = at(x, y);
      cloth.height_mm(x, y) = static_cast<float>(kPitchMm * point.first);
      cloth.normal(x, y, 0) = static_cast<float>(point.second.x);
      cloth.normal(x, y, 1) = static_cast<float>(point.second.y);
      cloth.normal(x, y, 2) = static_cast<float>(point.second.z);
    }
  }
  return cloth;
}

/// Like a weave with a period of 16 pixels: crossing ridges, mean slope 37 degrees, creased where they meet.
inline TestCloth bumpy_cloth(Size size) {
  const auto height_px = [](double x, double y) {
    const double a = std::cos(x * 2 * kPi / 16), b = std::cos(y * 2 * kPi / 16);
    return 4.4 * std::max(0.7 * a + 0.3 * a * b, 0.7 * b - 0.3 * a * b);
  };
  return cloth_over(size, [&](int x, int y) {
    constexpr double kStep = 1e-4;
    const Vec3 normal = {height_px(x - kStep, y) - height_px(x + kStep, y),
                         height_px(x, y + kStep) - height_px(x, y - kStep), 2 * kStep};
    return std::pair{height_px(x, y), normalized(normal)};
  });
}

/// An endless groove along the columns, walls at 45 degrees, its bottom in the middle of the picture.
inline constexpr int kGrooveHalf = 17;  ///< columns from bottom to rim
inline TestCloth groove(Size size) {
  return cloth_over(size, [&](int x, int y) {
    (void)y;
    const int from_bottom = x - size.width / 2;
    const double side = from_bottom < 0 ? 1 : -1;
    const bool is_wall = std::abs(from_bottom) < kGrooveHalf;
    return std::pair{1.0 * std::min(std::abs(from_bottom), kGrooveHalf),
                     is_wall ? normalized({side, 0, 1}) : Vec3{0, 0, 1}};
  });
}
/// The share of the sky that the other wall hides from a wall's point at this part of the way from bottom to
/// rim (crossed strings, Hottel 1954).
inline double hidden_in_groove(double part) {
  return (1 - part / std::hypot(part, 1)) / 2;
}

inline Vec3 direction_of(double elevation_deg, double azimuth_deg) {
  const double e = radians(elevation_deg), a = radians(azimuth_deg);
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

inline LightDirections distant(std::vector<Vec3> directions) {
  return {directions.size(), [directions](std::size_t k, int, int) { return directions[k]; }};
}

/// Six lights 28 degrees above the table and four 55 degrees, 300 to 600 mm away from a picture's corner.
inline LightDirections near_lights() {
  return {10, [](std::size_t k, int x, int y) {
            const Vec3 place_mm = {kPitchMm * x, -kPitchMm * y, 0};
            const double turn = static_cast<double>(k) * 60 + 15;
            return normalized((300.0 + 30.0 * static_cast<double>(k)) * direction_of(k < 6 ? 28 : 55, turn) -
                              place_mm);
          }};
}

template <typename T>
std::vector<View<T>> planes_of(Image<T>& image) {
  std::vector<View<T>> planes;
  for (int p = 0; p < image.planes(); ++p) planes.push_back(image.plane(p));
  return planes;
}

}  // namespace weft::solver
