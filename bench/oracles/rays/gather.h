// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bench/oracles/rays/height_grid.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/relief.h"

// Light that reaches a pixel from the cloth around it, and the share of the sky it sees: cosine-weighted
// rays.

namespace weft::test {

struct GatherSettings {
  /// A pixel, from 1 to kMostRays. On a deep white weave u errs by 0.05 rms at 8 rays, 0.031 at 16, 0.018 at
  /// 32, 0.011 at 64 and 0.0067 at 128, in the measure of x and independently from pixel to pixel.
  int rays = 32;
  int reach_px = 64;    ///< on the table; what is farther away is not met. At least two periods of the yarns.
  bool mosaic = false;  ///< as of solver::SliceSettings
};
inline constexpr int kMostRays = 4096;

/// What the pixels of `area` send back, as solver::RadiosityPlanes but side by side: `count` numbers a pixel,
/// row by row.
struct Radiosity {
  Rect area;  ///< holds all that is within reach of the tile (within_reach)
  int count = 0;
  std::span<const float> values;
};

/// The u_k of gather_by_slices() (solver/transport/slices.h) by rays:
///     u_k = 1/R sum of x_k(first point met by each of R rays),  0 for rays that leave.
///
/// `arriving[k](x - tile.x0, y - tile.y0)` is u_k. Rays of a pixel form a lattice (lattice.h) moved by a hash
/// of the pixel's coordinates: the same bytes for any tiles, blocks and threads. About a normal that is not
/// finite or does not look up, rays go about (0, 0, 1). Rays beyond the relief's border leave: u is too low
/// within the reach of the border. kBadData as check_tile, for settings out of range, for planes or values
/// that do not fit, and where a radiosity that was met is not finite.
Result<void> gather_light(const HeightGrid& grid, Rect tile, const solver::Normals& normals,
                          const Radiosity& radiosity, const GatherSettings& settings,
                          std::span<const View<float>> arriving);

/// The share of the same rays that leave: 1 on a plane, whatever its tilt. `mosaic` is not looked at.
Result<void> trace_openness(const HeightGrid& grid, Rect tile, const solver::Normals& normals,
                            const GatherSettings& settings, View<float> openness);

/// The packets that both would trace, in their order, of arguments that they take: for measurements.
std::vector<RayPacket> gather_packets(const HeightGrid& grid, Rect tile, const solver::Normals& normals,
                                      const GatherSettings& settings);

}  // namespace weft::test
