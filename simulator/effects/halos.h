// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/base/result.h"
#include "simulator/effects/passes.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"

namespace weft::simulator {

/// How far the passes of a scene look beyond a tile. Reaches are millimetres on the table, the rest pixels.
struct Halos {
  double shadow_mm = 0;  ///< the longest shadow
  double bounce_mm = 0;  ///< how far light is followed from cloth to cloth
  int shadow = 0;
  int bounce = 0;  ///< of one bounce
  int bounces = 0;
  int translucency = 0;
  int field = 0;
  int blur = 0;
  int chromatic = 0;
  int bloom_rows = 0;

  /// What the lens spreads into a tile.
  int of_signal() const { return field + blur + chromatic + bloom_rows; }
  /// Where light must be known before shadows: what lights the tile by way of the cloth and through it.
  int of_light() const { return of_entered() + bounces * bounce; }
  /// Where light must be known that enters the cloth.
  int of_entered() const { return of_signal() + translucency; }
  int all() const { return of_light() + shadow; }
};

/// kBadData where a shadow or light within the cloth would reach over kLongestReach pixels.
Result<Halos> halos_of(const Scene& scene, const SceneRig& rig);
inline constexpr int kLongestReach = 640;

/// How far light is followed within the cloth, pixels.
int translucency_reach(const Scene& scene);

/// Light that leaves a point at a grazing angle is followed this many times the cloth's relief, but no
/// farther than kFarthestBounce pixels.
inline constexpr double kBounceOverRelief = 8;
inline constexpr int kFarthestBounce = 96;

inline Rect grown_in_rows(Rect r, int by) {
  return {r.x0, r.y0 - by, r.x1, r.y1 + by};
}

}  // namespace weft::simulator
