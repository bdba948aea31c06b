// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"

namespace weft {

/// Coarser levels of a plane that are no means of the finer ones.
struct PlaneLevels {
  std::size_t plane = 0;
  std::vector<Image<float>> levels = {};  ///< 1, 2 ... down to 1 x 1: sides halved and rounded down
};

struct TiledTextureOptions {
  SampleType type = SampleType::kHalf;  ///< kHalf or kFloat
  bool is_periodic = false;             ///< else it ends at its borders
  bool is_prman = false;                ///< with the metadata that RenderMan looks for
  ImageAttributes attributes = {};
  PixelPitch pitch_mm = {};
  ColorSpace color = ColorSpace::kData;
  std::span<const PlaneLevels> own_levels = {};
};

/// A tiled, mip-mapped OpenEXR file (.tx) as renderers page it in: tiles of 64, zip, levels down to 1 x 1 by
/// plain means where a plane has none of its own, so that normals of coarse levels are shorter than 1.
/// Written aside and renamed; the same bytes for the same pixels, without a date and a command line. Errors:
/// kUsage for another type, no planes or levels of other sizes, kCannotCreate, kInputOutput with the reason.
Result<void> write_tiled_texture(const std::filesystem::path& file, std::span<const View<const float>> planes,
                                 const std::vector<std::string>& channels,
                                 const TiledTextureOptions& options);

}  // namespace weft
