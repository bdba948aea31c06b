// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/light_directions.h"
#include "solver/transport/relief.h"

namespace weft::solver {

/// Sets bit k % 32 of visible[k / 32](x - tile.x0, y - tile.y0) where the pixel (x, y) faces light k (n . l
/// over 0) and the relief does not stand between them within `reach_px`; clears it elsewhere, also for a
/// normal that is not finite. Light comes from the light's middle: penumbras have no width.
///
/// Heights between four pixels are compared with the straight way to the light every half pixel as far as the
/// relief is high. The pixels of one cell of directions and one row look along the direction in its middle,
/// each with the elevation of its own light: with light from 600 mm and 0.04 mm a pixel that misses a point
/// 40 pixels away by 0.02 pixels. Bytes depend on neither tiles nor threads. kBadData for a tile not inside
/// the relief, for a reach under a pixel, for lights without directions and for planes that do not hold the
/// tile.
Result<void> march_to_lights(const Relief& relief, Rect tile, const Normals& normals,
                             const LightDirections& lights, int reach_px,
                             std::span<const View<std::uint32_t>> visible);

}  // namespace weft::solver
