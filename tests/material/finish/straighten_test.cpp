// SPDX-License-Identifier: Apache-2.0
#include "material/finish/straighten.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "core/solve_record.h"
#include "material/finish/mean_repeat.h"
#include "tests/material/weave.h"

namespace weft::material {
namespace {

Straightened straightened(const Surface& surface, const StraightenOptions& options = {}) {
  const Result<Lattice> lattice = find_lattice(surface);
  EXPECT_TRUE(lattice) << lattice.error().message();
  Result<Straightened> out = straighten(surface, *lattice, options);
  EXPECT_TRUE(out) << out.error().message();
  return out ? std::move(out).value() : Straightened();
}

/// The farthest that a warp or a weft yarn is turned from its axis, in degrees, at three by three places.
double farthest_turn_deg(const Straightened& found, const WeaveSettings& settings, Size frame) {
  const Weave weave(settings);
  const Size grid = found.surface.size();
  const double half = 2 * std::max(settings.pitch_x_px, settings.pitch_y_px);
  const auto cloth_at = [&](double x, double y) { return weave.place(found.lookup.at(x, y).at, frame).at; };
  double farthest = 0;
  for (const double u : {0.15, 0.5, 0.85}) {
    for (const double v : {0.15, 0.5, 0.85}) {
      const double x = u * grid.width, y = v * grid.height;
      const Vec2 up = cloth_at(x, y - half) - cloth_at(x, y + half),
                 right = cloth_at(x + half, y) - cloth_at(x - half, y);
      farthest = std::max({farthest, std::abs(degrees(std::atan2(up.x, up.y))),
                           std::abs(degrees(std::atan2(right.y, right.x)))});
    }
  }
  return farthest;
}

TEST(Straighten, Explore) {
  for (const WeaveSettings& w :
       {WeaveSettings{.pitch_x_px = 21.6, .pitch_y_px = 21.6, .turn_deg = 1.9, .wander = 0.03, .warp_px = 1},
        WeaveSettings{.binding = kTwill,
        .pitch_x_px = 14.2,
        .pitch_y_px = 13.1,
        .turn_deg = 2.1,
        .wander = 0.04,
        .warp_px = 1},
        WeaveSettings{.binding = kSatin5,
        .pitch_x_px = 11.3,
        .pitch_y_px = 13.7,
        .turn_deg = -.8,
        .wander = 0.04,
        .warp_px = 1},
        WeaveSettings{.binding = kSatin5,
        .pitch_x_px = 11.3,
        .pitch_y_px = 13.7,
        .turn_deg = -.8,
        .wander = 0.04,
        .warp_px = 1,
        .bow_px = 12}}) {
    const Surface s = weave_surface(w, {1024, 1024});
    for (double sigma : {0., .5, .8, 1.5}) {
      const double t0 = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
      const Straightened f = straightened(s, {.lock_in_repeats = sigma});
      const double t1 = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
      const double rx = static_cast<double>(f.period_px.width) / f.repeats_x,
                   ry = static_cast<double>(f.period_px.height) / f.repeats_y;
      std::printf(
          "%s bow %.0f sigma %.1f: share %.3f turn %.4f size %d x %d period %d x %d = %d x %d pull %.3f %.3f "
          "mm %.2f s\n",
          w.binding.name, w.bow_px, sigma, repeating_share(f.surface, rx, ry),
          farthest_turn_deg(f, w, {1024, 1024}), f.surface.size().width, f.surface.size().height,
          f.period_px.width, f.period_px.height, f.repeats_x, f.repeats_y, f.largest_pull_mm, f.rms_pull_mm,
          t1 - t0);
    }
  }
}

}  // namespace
}  // namespace weft::material
