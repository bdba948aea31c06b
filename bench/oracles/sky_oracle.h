// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"

// What a point of a height map sees of the sky, slowly: what maps of occlusion are measured against.

namespace weft::test {

/// Normals by central differences over a tile that does not touch the border, three planes.
Image<float> normals_of_heights(const Image<float>& height_mm, double mm_per_pixel, Rect tile);

/// Openness of a tile by 1024 cosine-weighted rays a pixel about those normals, which go 100 pixels far.
Result<Image<float>> openness_by_rays(const Image<float>& height_mm, double mm_per_pixel, Rect tile);

struct MarchedSky {
  double openness = 0;
  Vec3 bent_normal;
};
/// One pixel: horizons in 64 directions by steps of half a pixel over the bilinear map, and sums over the sky
/// in steps of a degree.
MarchedSky sky_by_marching(const Image<float>& height_mm, double mm_per_pixel, int x, int y);

}  // namespace weft::test
