// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "simulator/effects/passes.h"
#include "simulator/transport/bounces.h"
#include "simulator/transport/height_mesh.h"

namespace weft::simulator {

/// What the passes that trace rays keep of a tile.
struct Transport {
  HeightMesh mesh;  ///< over Tile::area
  std::optional<Bounces> bounces;
};

/// Streams of random numbers beside those of the LEDs' shadows, which have the LED's number.
inline constexpr std::uint32_t kBounceStream = 0xFFFFFFFC;

}  // namespace weft::simulator
