// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/image.h"
#include "core/result.h"
#include "solver/transport/lights.h"
#include "solver/transport/relief.h"

namespace weft::solver {

/// The bits of find_visible_lights(), which is its truth, without a grid: heights between four pixels are
/// compared with the straight way to the light every half pixel as far as the relief is high. The pixels of
/// one cell of directions and one row look along the direction in its middle, each with the elevation of
/// its own light: with light from 600 mm and 0.04 mm a pixel that misses a point 40 pixels away by 0.02
/// pixels. Bytes depend on neither tiles nor threads. Errors as there.
Result<void> march_to_lights(const Relief& relief, Rect tile, const Normals& normals,
                             const LightDirections& lights, int reach_px,
                             std::span<const View<std::uint32_t>> visible);

}  // namespace weft::solver
