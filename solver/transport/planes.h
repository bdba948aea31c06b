// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "solver/transport/light_directions.h"
#include "solver/transport/relief.h"

// What the functions of this folder ask of the tiles they are given.

namespace weft::solver {

/// kBadData, about `where`.
Error bad_transport(std::string where, std::string why, std::string remedy);

/// Whether `inner` has pixels, all of them inside `outer`.
bool holds_pixels(Rect outer, Rect inner);

/// Whether a plane holds the pixels of a tile, whose corner is its (0, 0).
template <typename T>
bool holds_tile(const View<T>& plane, Rect tile) {
  return !plane.empty() && plane.width() >= tile.width() && plane.height() >= tile.height();
}

/// kBadData where one of the three planes does not hold the tile.
Result<void> check_normals(const Normals& normals, Rect tile);

/// kBadData for lights without directions, and where the planes do not hold a bit a light for the tile.
Result<void> check_visibility(Rect tile, const LightDirections& lights,
                              std::span<const View<std::uint32_t>> visible);

/// The normal at a place of the tile, or (0, 0, 1) where it is not finite or does not look up.
Vec3 normal_or_up(const Normals& normals, int column, int row);

}  // namespace weft::solver
