// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "material/finish/straighten.h"
#include "material/smooth_map.h"
#include "tests/material/weave.h"

namespace weft::material {

inline Straightened straightened(const Surface& surface, const StraightenOptions& options = {}) {
  const Result<Lattice> lattice = find_lattice(surface);
  EXPECT_TRUE(lattice) << lattice.error().message();
  if (!lattice) return {};
  Result<Straightened> out = straighten(surface, *lattice, options);
  EXPECT_TRUE(out) << out.error().message();
  return out ? std::move(out).value() : Straightened();
}

/// The farthest that a warp or a weft yarn is turned from its axis over 96 pixels, in degrees, at three by
/// three places.
inline double farthest_turn_deg(const Straightened& found, const WeaveSettings& settings, Size frame) {
  const Weave weave(settings);
  const Size grid = found.surface.size();
  const double half = 48;
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

/// Random relief and albedo with features of about two pixels: a cloth without repeat.
inline Surface felt_surface(Size size) {
  Surface surface = weave_surface({.tone = 0}, size);
  std::mt19937 random(11);
  std::normal_distribution<float> normal;
  const auto fill = [&](View<float> plane, float mean, float spread) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) plane(x, y) = normal(random);
    }
    smooth(plane, 1.2, 0);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) plane(x, y) = mean + spread * plane(x, y);
    }
  };
  for (int p = 0; p < 2; ++p) fill(surface.slope.plane(p), 0, 1);
  for (int p = 0; p < 3; ++p) fill(surface.albedo.plane(p), 0.3F, 0.1F);
  return surface;
}

}  // namespace weft::material
