// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/sky_oracle.h"

#include <algorithm>
#include <cmath>

#include "bench/oracles/rays/gather.h"
#include "solver/transport/relief.h"

namespace weft::test {
namespace {

constexpr int kSkyReach_px = 100;

Vec3 normal_at(const Image<float>& height, double mm_per_pixel, int x, int y) {
  const auto h = [&](int u, int v) { return static_cast<double>(height(u, v)); };
  return normalized({h(x - 1, y) - h(x + 1, y), h(x, y + 1) - h(x, y - 1), 2 * mm_per_pixel});
}

double bilinear(const Image<float>& height, double x, double y) {
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const double u = x - left, v = y - top;
  const auto h = [&](int column, int row) { return static_cast<double>(height(column, row)); };
  return (1 - v) * ((1 - u) * h(left, top) + u * h(left + 1, top)) +
         v * ((1 - u) * h(left, top + 1) + u * h(left + 1, top + 1));
}

// Elevation of the horizon in radians.
double elevation(const Image<float>& height, double mm_per_pixel, int x, int y, double turn) {
  const double here = static_cast<double>(height(x, y)), c = std::cos(turn), s = std::sin(turn);
  double steepest = -1e9;
  for (double way = 1; way <= kSkyReach_px; way += 0.5) {
    const double at_x = x + way * c, at_y = y - way * s;
    if (!(at_x >= 0 && at_y >= 0 && at_x < height.width() - 1 && at_y < height.height() - 1)) break;
    steepest = std::max(steepest, (bilinear(height, at_x, at_y) - here) / way);
  }
  return std::atan(steepest / mm_per_pixel);
}

}  // namespace

Image<float> normals_of_heights(const Image<float>& height_mm, double mm_per_pixel, Rect tile) {
  Image<float> normal({tile.width(), tile.height()}, 3);
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) {
      const Vec3 n = normal_at(height_mm, mm_per_pixel, x + tile.x0, y + tile.y0);
      normal(x, y, 0) = static_cast<float>(n.x);
      normal(x, y, 1) = static_cast<float>(n.y);
      normal(x, y, 2) = static_cast<float>(n.z);
    }
  }
  return normal;
}

Result<Image<float>> openness_by_rays(const Image<float>& height_mm, double mm_per_pixel, Rect tile) {
  const auto relief = solver::Relief::of(height_mm.plane(), mm_per_pixel);
  if (!relief) return relief.error();
  const auto grid = HeightGrid::build(*relief, tile, kSkyReach_px + 1);
  if (!grid) return grid.error();
  const Image<float> normal = normals_of_heights(height_mm, mm_per_pixel, tile);
  Image<float> openness({tile.width(), tile.height()});
  const auto done = trace_openness(*grid, tile, {normal.plane(0), normal.plane(1), normal.plane(2)},
                                   {.rays = 1024, .reach_px = kSkyReach_px}, openness.plane());
  if (!done) return done.error();
  return openness;
}

MarchedSky sky_by_marching(const Image<float>& height_mm, double mm_per_pixel, int x, int y) {
  constexpr int kTurns = 64, kElevations = 90;
  const Vec3 n = normal_at(height_mm, mm_per_pixel, x, y);
  double seen = 0, all = 0;
  Vec3 mean;
  for (int k = 0; k < kTurns; ++k) {
    const double turn = 2 * kPi * (k + 0.5) / kTurns;
    const double horizon = elevation(height_mm, mm_per_pixel, x, y, turn);
    for (int i = -kElevations; i < kElevations; ++i) {  // below the horizontal too: sheets may be tilted
      const double up = kPi / 2 * (i + 0.5) / kElevations;
      const Vec3 way = {std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up)};
      const double weight = std::max(dot(way, n), 0.0) * std::cos(up);
      all += weight;
      if (up < horizon) continue;
      seen += weight;
      mean = mean + weight * way;
    }
  }
  return {seen / all, normalized(mean)};
}

}  // namespace weft::test
