// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/image.h"
#include "core/result.h"
#include "solver/transport/relief.h"

// Light that reaches a pixel from the cloth around it, without rays.

namespace weft::solver {

struct SliceSettings {
  /// To all sides of a pixel, from 4 to 64. On a deep weave of albedo 0.5 u errs by 0.007 rms with 8 and
  /// 0.005 with 16, where gather_light errs by 0.010 with 32 rays and by 0.006 with 64 and takes 18 times as
  /// long. It is too low by 0.001: what lies between two points is not seen.
  int directions = 12;
  int reach_px = 64;    ///< on the table; what is farther away is not met. At least two periods of the yarns.
  bool mosaic = false;  ///< as of GatherSettings
};

/// What the pixels of `area` send back, a plane a light (and channel), as Radiosity of gather.h but 0 where
/// there is no picture. Rows are padded (core/image.h).
struct RadiosityPlanes {
  Rect area;  ///< in pixels of the picture, and may go beyond it
  std::span<const View<const float>> planes;
};

/// The area whose radiosity gather_by_slices() reads for a tile, whether the picture has all of it or not.
Rect area_of_slices(Rect tile, int reach_px);

/// The u of gather_light(), which is its truth, from the horizons of a pixel. In the vertical half-plane of
/// each direction a ray at elevation e meets the first point that stands at e or higher. So whenever the
/// horizon rises, from e0 to e1, on the way outwards, all that is between is light of the point that raises
/// it, and its share of the hemisphere is known in closed form: with t = tan e, n the normal, d the
/// direction and N directions
///     2 / N (F(t1) - F(t0)),   2 F(t) = n . d (atan t + t / (1 + t^2)) + n.z t^2 / (1 + t^2)
/// (the integral of cos e (n . omega) over e). The first horizon is the pixel's own tangent plane. Horizons
/// with the light of what raises them are those of Mayaux ("Horizon-based indirect lighting", 2018), their
/// integral that of openness (Jimenez et al. 2016); here it is of the true radiosity and without screen
/// space.
///
/// Points are half a pixel apart near the pixel and a 16th of their distance farther out, their heights
/// between four pixels, their radiosity that of the nearest pixel (of a mosaic: of one colour) half a step
/// nearer. All pixels look in the same directions: no noise, and the same bytes for any tiles and threads.
/// Normals, border and errors as gather_light().
Result<void> gather_by_slices(const Relief& relief, Rect tile, const Normals& normals,
                              const RadiosityPlanes& radiosity, const SliceSettings& settings,
                              std::span<const View<float>> arriving);

}  // namespace weft::solver
