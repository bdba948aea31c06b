// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "exchange/document.h"
#include "exchange/gltf/glb.h"

// The material of a glTF asset, without its container.

namespace weft::exchange {

/// What `materials[0]` is and what it needs.
struct GltfMaterial {
  Json material;
  std::vector<std::string> files;       ///< `textures` by their index
  std::vector<std::string> extensions;  ///< sorted
  std::vector<std::string> left_out;
};

/// `transform`: the KHR_texture_transform of every texture, or null.
Result<GltfMaterial> gltf_material_of(const TexturedMaterial& material, AlphaMode alpha_mode,
                                      const Json& transform);

}  // namespace weft::exchange
