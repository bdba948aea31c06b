// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "core/base/vec.h"
#include "solver/transport/relief.h"

// The lights over a relief, how far their shadows reach, and a bit for each.

namespace weft::solver {

/// `at(light, x, y)` is the unit direction in the rig frame from a pixel's point to a light, such as
/// LightField::at(k, c, x, y).direction. Asked once every kCell pixels and blended between; with light from
/// 600 mm and 0.04 mm a pixel that is off by 2e-7 radians. `at` is called from the calling thread.
struct LightDirections {
  static constexpr int kCell = 16;
  std::size_t count = 0;
  std::function<Vec3(std::size_t light, int x, int y)> at;
};

/// How far on the table a shadow may come from.
struct ShadowReach {
  int reach_px = 0;
  bool is_capped = false;  ///< the relief could cast shadows from farther away: they are missed
};
/// The height range over the tangent of the lowest light's elevation, which is at a corner of the picture,
/// but at most `most_px`: what a halo costs in memory. Folds of 10 mm at 0.04 mm a pixel under light from 28
/// degrees reach 470 pixels.
inline constexpr int kMostReach_px = 512;
ShadowReach shadow_reach(const Relief& relief, const LightDirections& lights, int most_px = kMostReach_px);

/// Planes of 32 bits for this many lights.
constexpr int visibility_words(std::size_t lights) {
  return static_cast<int>((lights + 31) / 32);
}

}  // namespace weft::solver
