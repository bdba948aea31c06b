// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/image/compression.h"
#include "core/image/image.h"
#include "material/surface.h"

namespace weft::material {

std::vector<View<const float>> planes_of(const Image<float>& map);

/// X, Y, Z of unit normals, (-x, -y, 1) by their slopes.
Image<float> normals_of(const Image<float>& slope);

/// The maps of a folder that weft rectify made, as a surface.
struct RectifiedSurface {
  Surface surface;
  /// Its lobe has a measured f0. One of an albedo without a scale has none: there it is kTypedF0.
  bool has_f0 = false;
  bool is_size_known = true;  ///< else files state none
};
/// Errors of read_image(); kBadData where sizes differ or a value is not finite.
Result<RectifiedSurface> read_surface(const std::filesystem::path& rectified, double mm_per_pixel);

/// normal.exr, albedo.exr, sigma.exr (normal_deg), status.png and, where the surface has them, opacity.exr,
/// roughness.exr and, with a measured f0, specular.exr, with channels and types as in docs/formats.md.
Result<void> write_surface(const std::filesystem::path& folder, const RectifiedSurface& rectified,
                           Compression compression);

}  // namespace weft::material
