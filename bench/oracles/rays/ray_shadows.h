// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/oracles/rays/height_grid.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/light_directions.h"
#include "solver/transport/relief.h"

// Cast and attached shadows of a relief by rays: which light a pixel sees.

namespace weft::test {

/// The bits of march_to_lights() (solver/transport/marched_shadows.h) by one ray a pixel and light.
/// The grid is of triangles between pixel centres: a shadow's edge is that of a surface without detail below
/// a pixel. kBadData as check_tile, for lights without directions and for planes that do not hold the tile.
Result<void> find_visible_lights(const HeightGrid& grid, Rect tile, const solver::Normals& normals,
                                 const solver::LightDirections& lights, int reach_px,
                                 std::span<const View<std::uint32_t>> visible);

/// The packets that find_visible_lights would trace, in its order, of arguments that it takes: for
/// measurements.
std::vector<RayPacket> shadow_packets(const HeightGrid& grid, Rect tile, const solver::Normals& normals,
                                      const solver::LightDirections& lights, int reach_px);

}  // namespace weft::test
