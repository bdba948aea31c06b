// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "exchange/document.h"

// Materials as MaterialX 1.39 text (Academy Software Foundation; OpenPBR 1.1, Autodesk Standard
// Surface 1.0.1, glTF PBR 2.0.1). Parameters change their convention by nodes, so texels stay as they are.

namespace weft::exchange {

enum class SurfaceModel { kOpenPbr, kStandardSurface, kGltfPbr };

struct MaterialXOptions {
  /// Each becomes a surfacematerial of its own, named after the cloth: the first NAME, further ones
  /// NAME_standard_surface and so on. three.js 0.187 reads each of them, and no mix.
  std::vector<SurfaceModel> models = {SurfaceModel::kOpenPbr, SurfaceModel::kStandardSurface};
  /// What one unit of UV covers; none: one texture, so that UV from 0 to 1 shows all of it.
  std::optional<std::array<double, 2>> uv_covers_mm = {};
  /// Heights as a displacement in metres too. Normals then count the relief again where a renderer
  /// displaces finely.
  bool has_displacement = false;
};

/// The name of a model's node: "open_pbr_surface".
const char* name_of(SurfaceModel model);

/// The material. Textures are `tiledimage` nodes with their true size in metres where it is known. Sheen is
/// OpenPBR's fuzz with its own lobe, the one of standard_surface with the roughness squared, and that of
/// gltf_pbr as it is: the weight is the texture's scale, so sheen is best written with texels up to 1.
/// kBadData: as check_material(); no model or one twice; `uv_covers_mm` without a known size.
Result<Document> materialx_of(const TexturedMaterial& material, const MaterialXOptions& options = {});

/// Where the weights of layers that are mixed while they are drawn come from: a texture with "rgb", or the
/// colours of vertices.
struct RuntimeWeights {
  std::optional<Texture> texture = {};  ///< covers UV from 0 to 1 once; none: vertex colours
};

/// Up to four materials, bottom to top. The first covers all; the second is mixed over it by R, the third
/// over both by G, the fourth by B, in surface shaders of the first model of the options. UV are those of the
/// first material, and each keeps its own true size. kBadData: as materialx_of(); none or above four; some
/// sizes known and some not; a weight texture in sRGB or without the channels.
Result<Document> materialx_mix_of(const std::string& name, std::span<const TexturedMaterial> layers,
                                  const RuntimeWeights& weights, const MaterialXOptions& options = {});

}  // namespace weft::exchange
