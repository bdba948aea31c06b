// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bench/oracles/rays/height_grid.h"
#include "core/image.h"
#include "core/result.h"
#include "solver/transport/relief.h"

// Light that reaches a pixel from the cloth around it, and the share of the sky it sees: cosine-weighted
// rays.

namespace weft::test {

struct GatherSettings {
  /// A pixel, from 1 to kMostRays. On a deep white weave u errs by 0.05 rms at 8 rays, 0.031 at 16, 0.018 at
  /// 32, 0.011 at 64 and 0.0067 at 128, in the measure of x and independently from pixel to pixel.
  int rays = 32;
  int reach_px = 64;  ///< on the table; what is farther away is not met. At least two periods of the yarns.
  /// The readings are of a Bayer mosaic: what a ray met is read at the nearest pixel of the same place in the
  /// 2 x 2 cell as the pixel that the light arrives at, so that both have one colour.
  bool mosaic = false;
};
inline constexpr int kMostRays = 4096;

/// What the pixels of `area` send back: `count` numbers a pixel, side by side, row by row. One a light for a
/// mosaic, one a light and channel for photographs in colour: x = reading / e, the reading over that of a
/// white surface that faces the light (radiosity over irradiance, all shadows and bounces included).
/// All must be finite: the caller replaces readings that cannot be used.
struct Radiosity {
  Rect area;  ///< holds all that is within reach of the tile (within_reach)
  int count = 0;
  std::span<const float> values;
};

/// The cosine-weighted mean over the hemisphere of the radiosity that surrounds each pixel of the tile,
///     u_k = 1/R sum of x_k(first point met by each of R rays),  0 for rays that leave,
/// in the measure of x: of a pixel with albedo rho, x_k = rho (V_k n . l_k + u_k). A Lambertian surface sends
/// the same radiance everywhere, so the camera has measured what reaches the pixel, and no bounce needs to be
/// followed (the integral equation of Nayar, Ikeuchi and Kanade, IJCV 6(3), 1991, eq. 4 to 9, but with the
/// measured radiosity inserted instead of solved for). That a glossy point sends another radiance sideways
/// than upwards is neglected.
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
