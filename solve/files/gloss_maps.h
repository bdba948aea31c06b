// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/image/compression.h"
#include "core/image_io/image_io.h"
#include "core/rig/albedo_scale.h"
#include "solve/gloss/gloss.h"

namespace weft::solve {

/// What artists are given where no lobe was measured, and it is called typed: f0 of cellulose, roughness of
/// matt cloth.
inline constexpr double kTypedF0 = 0.04, kTypedAlpha = 1;

/// Writes what a measured lobe says by pixel, beside the status.png of `folder`, which tells where it holds:
///   roughness.exr    roughness (the root of alpha; of two, of their geometric mean), alpha (across the
///   yarn),
///                    alpha_along, yarn_deg (azimuth from the x axis of the rig, 0 where there is none); of
///                    two lobes in a pixel alpha_of_one()
///   specular.exr     f0, of an absolute albedo alone: that of a relative one has its unknown scale; where a
///                    lobe has a tint also R, G, B, of which f0 is then the largest
///   reflectance.png  where which lobe holds and how yarns lie; only if `previews`
/// Pixels without GLOSSY have typed values. Nothing is written where no lobe was measured or none is used.
/// Errors: of files; kTryAgain where memory is short.
Result<void> write_gloss_maps(const std::filesystem::path& folder, const GlossFacts& facts, AlbedoScale scale,
                              Compression compression, PixelPitch pitch_mm, bool previews);

}  // namespace weft::solve
