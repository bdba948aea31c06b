// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/vec.h"
#include "material/smooth_map.h"
#include "material/surface.h"
#include "tests/material/weave.h"

// Cloths without two repeats, for tests.

namespace weft::material {

/// Random relief with features of about `feature_px` pixels.
inline Surface felt(Size size, double feature_px) {
  Surface surface = weave_surface({}, size);
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  for (int p = 0; p < 2; ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) surface.slope(x, y, p) = normal(random);
    }
    smooth(surface.slope.plane(p), feature_px, 0);
  }
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < size.height; ++y) std::fill_n(surface.albedo.plane(p).row(y), size.width, 0.3F);
  }
  return surface;
}

/// Ribs of `pitch_px`, their way across turned by `turn_deg`, and fuzz on them.
inline Surface corduroy(Size size, double pitch_px, double turn_deg) {
  Surface surface = felt(size, 1);
  const double c = std::cos(radians(turn_deg)), s = std::sin(radians(turn_deg));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double slope = 0.5 * std::sin(2 * kPi * (c * x - s * y) / pitch_px);
      surface.slope(x, y, 0) = 0.3F * surface.slope(x, y, 0) + static_cast<float>(c * slope);
      surface.slope(x, y, 1) = 0.3F * surface.slope(x, y, 1) + static_cast<float>(s * slope);
    }
  }
  return surface;
}

}  // namespace weft::material
