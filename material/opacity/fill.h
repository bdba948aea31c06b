// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "material/surface.h"

namespace weft::material {

struct FillOptions {
  double least_opacity = 0.3;  ///< pixels below have no cloth to speak of
  int reach_px = 8;            ///< how far cloth reaches into a hole; 0 to 64
  int threads = 0;
};

struct FillFacts {
  std::int64_t filled = 0;    ///< pixels that took values of cloth within reach
  std::int64_t levelled = 0;  ///< pixels too far from any: level, in the mean of the cloth
};

/// Gives holes and pixels without a solution the slope, albedo and lobe of the cloth around them, so that
/// filters and mips bleed neither table nor black into the cloth. A pixel takes the mean slope and albedo of
/// cloth within reach, weighed by one over the squared distance, and the lobe of the nearest (azimuths have
/// no mean). Beyond reach it is level, with the mean albedo of all cloth and a lobe of its mean alpha, as
/// wide both ways. Opacity, sigma and status stay, so that what was filled is still known as such. Of a tile,
/// cloth beyond the border is that of the other side. Without any cloth all is level and black.
FillFacts fill_holes(Surface& surface, const FillOptions& options = {});

}  // namespace weft::material
