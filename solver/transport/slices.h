// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solver/transport/relief.h"

// Light that reaches a pixel from the cloth around it.

namespace weft::solver {

struct SliceSettings {
  /// To all sides of a pixel, from 4 to 64. On a deep weave of albedo 0.5 u errs by 0.007 rms with 8 and
  /// 0.005 with 16. It is too low by 0.001: what lies between two points is not seen. 32 rays a pixel err by
  /// 0.010. 64 rays err by 0.006 and take 18 times as long as 16 directions.
  int directions = 12;
  int steps = 16;  ///< points lie one over this of their distance apart, and at least half a pixel; 4 to 64
  int reach_px = 64;  ///< on the table; what is farther away is not met. At least two periods of the yarns.
  /// The readings are of a Bayer mosaic: the light of a point is read at the nearest pixel of the same place
  /// in the 2 x 2 cell as the pixel that it arrives at, so that both have one colour.
  bool mosaic = false;
};

/// What the pixels of `area` send back, a plane a light for a mosaic, a plane a light and channel for
/// photographs in colour: x = reading / e, the reading over that of a white surface that faces the light
/// (radiosity over irradiance, all shadows and bounces included). 0 where there is no picture. All must be
/// finite: the caller replaces readings that cannot be used. Rows are padded (core/image/image.h).
struct RadiosityPlanes {
  Rect area;  ///< in pixels of the picture, and may go beyond it
  std::span<const View<const float>> planes;
};

/// The area whose radiosity gather_by_slices() reads for a tile, whether the picture has all of it or not.
Rect area_of_slices(Rect tile, int reach_px);

/// The cosine-weighted mean u_k over the hemisphere of the radiosity that surrounds each pixel of the tile, 0
/// where there is sky, in the measure of x: of a pixel with albedo rho, x_k = rho (V_k n . l_k + u_k). A
/// Lambertian surface sends the same radiance everywhere, so the camera has measured what reaches the pixel,
/// and no bounce needs to be followed (the integral equation of Nayar, Ikeuchi and Kanade, IJCV 6(3), 1991,
/// eq. 4 to 9, but with the measured radiosity inserted instead of solved for). That a glossy point sends
/// another radiance sideways than upwards is neglected.
///
/// u_k comes from the horizons of a pixel. In the vertical half-plane of each direction a line of sight at
/// elevation e meets the first point that stands at e or higher. So whenever the horizon rises, from e0 to
/// e1, on the way outwards, all that is between is light of the point that raises it, and its share of the
/// hemisphere is known in closed form: with t = tan e, n the normal, d the direction and N directions
///     2 / N (F(t1) - F(t0)),   2 F(t) = n . d (atan t + t / (1 + t^2)) + n.z t^2 / (1 + t^2)
/// (the integral of cos e (n . omega) over e). The first horizon is the pixel's own tangent plane. Horizons
/// with the light of what raises them are those of Mayaux ("Horizon-based indirect lighting", 2018), their
/// integral that of openness (Jimenez et al. 2016); here it is of the true radiosity and without screen
/// space.
///
/// Points are half a pixel apart near the pixel and farther out in proportion to their distance, their
/// heights between four pixels, their radiosity that of the nearest pixel (of a mosaic: of one colour) half a
/// step nearer. All pixels look in the same directions: no noise, and the same bytes for any tiles and
/// threads.
///
/// `arriving[k](x - tile.x0, y - tile.y0)` is u_k. A normal that is not finite or does not look up counts as
/// (0, 0, 1). Beyond the relief's border there is nothing: u is too low within the reach of the border.
/// kBadData for settings out of range, for a tile not inside the relief, for planes that do not fit, and
/// where a radiosity that was met is not finite.
Result<void> gather_by_slices(const Relief& relief, Rect tile, const Normals& normals,
                              const RadiosityPlanes& radiosity, const SliceSettings& settings,
                              std::span<const View<float>> arriving);

}  // namespace weft::solver
