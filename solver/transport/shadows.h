// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "core/vec.h"
#include "solver/transport/height_grid.h"

// Cast and attached shadows of a height map: which light a pixel sees.

namespace weft::solver {

/// The unit normal of each pixel of a tile, planes X, Y and Z in the rig frame; (0, 0) is the tile's corner.
struct Normals {
  View<const float> x, y, z;
};

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

/// Sets bit k % 32 of visible[k / 32](x - tile.x0, y - tile.y0) where the pixel (x, y) faces light k (n . l
/// over 0) and the relief does not stand between them within `reach_px`; clears it elsewhere, also for a
/// normal that is not finite. One ray a pixel and light to the light's middle: penumbras have no width.
/// The grid is of triangles between pixel centres: a shadow's edge is that of a surface without detail below
/// a pixel. kBadData as check_tile, for lights without directions and for planes that do not hold the tile.
Result<void> find_visible_lights(const HeightGrid& grid, Rect tile, const Normals& normals,
                                 const LightDirections& lights, int reach_px,
                                 std::span<const View<std::uint32_t>> visible);

/// The packets that find_visible_lights would trace, in its order, of arguments that it takes: for
/// measurements.
std::vector<RayPacket> shadow_packets(const HeightGrid& grid, Rect tile, const Normals& normals,
                                      const LightDirections& lights, int reach_px);

}  // namespace weft::solver
