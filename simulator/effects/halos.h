// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/result.h"
#include "simulator/effects/passes.h"
#include "simulator/scene/rig.h"
#include "simulator/scene/scene.h"

namespace weft::simulator {

/// How far the passes of a scene look beyond a tile. Reaches are millimetres on the table, the rest pixels.
struct Halos {
  double shadow_mm = 0;  ///< the longest shadow
  double bounce_mm = 0;  ///< how far light is followed from cloth to cloth
  int shadow = 0;
  int bounce = 0;  ///< of one bounce
  int bounces = 0;
  int blur = 0;
  int bloom_rows = 0;

  /// What the lens spreads into a tile.
  int of_signal() const { return blur + bloom_rows; }
  /// Where light must be known before shadows: what lights the tile by way of the cloth.
  int of_light() const { return of_signal() + bounces * bounce; }
  int all() const { return of_light() + shadow; }
};

/// kBadData where a shadow would reach over kLongestShadow pixels.
Result<Halos> halos_of(const Scene& scene, const SceneRig& rig);
inline constexpr int kLongestShadow = 640;

/// Light that leaves a point at a grazing angle is followed this many times the cloth's relief, but no
/// farther than kFarthestBounce pixels.
inline constexpr double kBounceOverRelief = 8;
inline constexpr int kFarthestBounce = 96;

inline Rect grown_in_rows(Rect r, int by) {
  return {r.x0, r.y0 - by, r.x1, r.y1 + by};
}

}  // namespace weft::simulator
