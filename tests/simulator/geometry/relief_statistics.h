// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/vec.h"
#include "simulator/geometry/scene_surface.h"

// Slope, shadow and openness of a periodic surface by marching over a grid of its heights: slow, obvious and
// independent of the simulator's ray casting.

namespace weft::simulator {

struct ReliefStatistics {
  double mean_slope_deg = 0;  ///< between the normal and z
  double shadowed = 0;        ///< share of (point, light) pairs in attached or cast shadow
  double closed = 0;          ///< 1 - mean openness, cosine-weighted about each point's own normal
};

class ReliefGrid {
 public:
  ReliefGrid(const Surface& surface, int samples_per_period) : n_(samples_per_period) {
    const Period period = period_mm(surface).value();
    step_x_mm_ = period.x_mm / n_;
    step_y_mm_ = period.y_mm / n_;
    for (int j = 0; j < n_; ++j) {
      for (int i = 0; i < n_; ++i) points_.push_back(point_at(surface, i * step_x_mm_, j * step_y_mm_));
    }
    for (const SurfacePoint& p : points_) highest_mm_ = std::max(highest_mm_, p.height_mm);
  }

  ReliefStatistics statistics(const std::vector<Vec3>& lights) const {
    constexpr int kAzimuths = 16;
    ReliefStatistics sum;
    for (int j = 0; j < n_; ++j) {
      for (int i = 0; i < n_; ++i) {
        const Vec3 normal = point(i, j).normal;
        sum.mean_slope_deg += angle_deg(normal, {0, 0, 1});
        for (const Vec3& l : lights) {
          const double horizontal = std::hypot(l.x, l.y);
          const bool lit =
              dot(normal, l) > 0 && horizon(i, j, l.x / horizontal, l.y / horizontal) < l.z / horizontal;
          sum.shadowed += lit ? 0 : 1.0 / static_cast<double>(lights.size());
        }
        double open = 0;
        for (int a = 0; a < kAzimuths; ++a) {
          const double azimuth = 2 * kPi * (a + 0.5) / kAzimuths;
          open += openness(normal, i, j, std::cos(azimuth), std::sin(azimuth)) * 2 / kAzimuths;
        }
        sum.closed += 1 - open;
      }
    }
    const double count = n_ * n_;
    return {sum.mean_slope_deg / count, sum.shadowed / count, sum.closed / count};
  }

 private:
  const SurfacePoint& point(int i, int j) const {
    return points_[static_cast<std::size_t>(j) * static_cast<std::size_t>(n_) + static_cast<std::size_t>(i)];
  }

  double height_mm(double column, double row) const {
    const double i = std::floor(column), j = std::floor(row), right = column - i, up = row - j;
    const auto wrap = [&](double at) { return ((static_cast<int>(at) % n_) + n_) % n_; };
    const int i0 = wrap(i), i1 = wrap(i + 1), j0 = wrap(j), j1 = wrap(j + 1);
    return (1 - up) * ((1 - right) * point(i0, j0).height_mm + right * point(i1, j0).height_mm) +
           up * ((1 - right) * point(i0, j1).height_mm + right * point(i1, j1).height_mm);
  }

  /// Tangent of the elevation below which the surface hides the sky in a direction, at least 0.
  double horizon(int i, int j, double dx, double dy) const {
    const double from_mm = point(i, j).height_mm, step_mm = std::min(step_x_mm_, step_y_mm_);
    double steepest = 0;
    for (double run_mm = step_mm; steepest * run_mm < highest_mm_ - from_mm; run_mm += step_mm) {
      const double rise_mm = height_mm(i + dx * run_mm / step_x_mm_, j + dy * run_mm / step_y_mm_) - from_mm;
      steepest = std::max(steepest, rise_mm / run_mm);
      if (run_mm > 2 * n_ * std::max(step_x_mm_, step_y_mm_)) break;
    }
    return steepest;
  }

  /// One azimuth's integral of max(0, n . w) cos(e) de over elevations e above the horizon. Its mean
  /// over all azimuths, doubled, is 1 where nothing is hidden.
  double openness(Vec3 n, int i, int j, double dx, double dy) const {
    const double ahead = n.x * dx + n.y * dy;
    const double e = std::atan(std::max(horizon(i, j, dx, dy), -ahead / n.z));
    const double cosine = std::cos(e), sine = std::sin(e);
    return n.z * cosine * cosine / 2 + ahead / 2 * (kPi / 2 - e - sine * cosine);
  }

  int n_;
  double step_x_mm_ = 0;
  double step_y_mm_ = 0;
  double highest_mm_ = -1e30;
  std::vector<SurfacePoint> points_;
};

}  // namespace weft::simulator
