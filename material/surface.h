// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace weft::material {

/// The maps of a cloth on a square grid: what finishing works on, and what every other map is derived from.
/// Columns run along x, rows downwards; y is up the picture and z towards the camera, as in weft.rectified/1.
///
/// Slopes stand for normals, since means, warps and joints of slopes are again those of a surface:
/// n = (-x, -y, 1) / |(-x, -y, 1)|. Every map is finite; where `status` has kNoSolution slopes are 0.
struct Surface {
  double mm_per_pixel = 0;
  /// The right border goes on at the left one, and the lower at the upper.
  bool is_tile = false;

  Image<float> slope;           ///< 2 planes, mm of height a mm of way: to the right (x), up the picture (y)
  Image<float> albedo;          ///< 3 planes, linear Rec.709, or the camera's channels
  Image<float> sigma_deg;       ///< of the normal, degrees (rms angle); 180 where there is none
  Image<std::uint16_t> status;  ///< core/solve/solve_record.h
  Image<float> opacity;         ///< 0 hole to 1 cloth; empty: not measured
  /// 4 planes: alpha across and along, yarn azimuth in degrees, f0; 7 where highlights have colours: f0 of R,
  /// G and B after it, which is the largest of them; or empty.
  Image<float> lobe;

  Size size() const { return slope.size(); }
};

}  // namespace weft::material
