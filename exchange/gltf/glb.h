// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "core/base/result.h"
#include "exchange/document.h"

// A material as binary glTF 2.0 (Khronos, 2.0.1): a rectangle in the xy plane that looks along z, in metres.

namespace weft::exchange {

enum class AlphaMode { kMask, kBlend };

struct GlbOptions {
  std::array<int, 2> tiles = {1, 1};        ///< repeats that the rectangle shows, along x and y
  AlphaMode alpha_mode = AlphaMode::kMask;  ///< of a material with opacity; a mask cuts at 0.5
};

/// The material with KHR_materials_sheen, _anisotropy, _specular, _ior and, for several tiles,
/// KHR_texture_transform, as far as it has what they hold. `images` has the bytes of each texture, PNG of 8
/// or 16 bits or JPEG; those that nothing uses are left out. `asset.extras.weft` holds `size_mm` and the
/// provenance; where the size is not known it is null, and the rectangle is a metre wide.
///
/// glTF fixes the channels: base colour RGB (sRGB) with opacity in A; occlusion R, roughness G, metallic B;
/// sheen colour RGB (sRGB); sheen roughness A; anisotropy direction RG with strength B of the same file; F0
/// in A. Height has no place.
///
/// kBadData: as check_material(); a texture elsewhere than that; an image that is missing, neither PNG nor
/// JPEG or of another size; several tiles of what does not repeat; 4 GiB and more.
Result<Document> glb_of(const TexturedMaterial& material, const FileBytes& images,
                        const GlbOptions& options = {});

}  // namespace weft::exchange
