// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "bench/oracles/rays/height_grid.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/pixel_hash.h"
#include "solver/transport/relief.h"

// Light that reaches a pixel from the cloth around it, and the share of the sky it sees: cosine-weighted
// rays.

namespace weft::test {

// Directions of cosine-weighted rays.

/// A point of the unit square whose sides are joined: [0, 1) both.
struct TorusPoint {
  float u = 0, v = 0;
};

/// The rank-1 lattice {(i / R, frac(i a / R))} with the `a` that keeps its points farthest apart
/// (Niederreiter, "Random number generation and quasi-Monte Carlo methods", 1992, chapter 5).
///
/// Moved by a shift it estimates a mean without bias if shifts fall evenly on one cell of the lattice, as the
/// lattice repeats from cell to cell: no need to shift by up to the whole square (Cranley and Patterson
/// 1976). So point i of one pixel lies near point i of any other, and rays of neighbouring pixels make good
/// packets.
struct Lattice {
  std::vector<TorusPoint> points;
  std::array<TorusPoint, 2> cell;  ///< two short vectors that span a cell, negative parts allowed
};
Lattice make_lattice(int points);

/// The shift of a pixel: evenly spread over the cell around (0, 0).
inline TorusPoint shift_of(const Lattice& lattice, solver::PixelHash hash) {
  constexpr float kToUnit = 1.0f / (1U << 24);
  const float s = static_cast<float>(hash.first >> 8) * kToUnit - 0.5f;
  const float t = static_cast<float>(hash.second >> 8) * kToUnit - 0.5f;
  return {s * lattice.cell[0].u + t * lattice.cell[1].u, s * lattice.cell[0].v + t * lattice.cell[1].v};
}

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
