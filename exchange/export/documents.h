// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "exchange/export/textured.h"
#include "exchange/presets/export_facts.h"
#include "material/assets/runtime.h"

namespace weft::exchange {

/// The layers of a material that is mixed while it is drawn.
struct ClothLayers {
  const material::RuntimeStack& stack;
  std::vector<ClothTextures> above;  ///< all of the stack but the lowest, which is the cloth itself
};

/// Writes the documents of a preset beside its textures, which are in `folder` already, and takes away
/// textures that stand inside of documents alone. One of `layers` (weft.layers/1, for engines) has two more
/// beside it: NAME_layers.mtlx with a mix of surface shaders, and the layers' weights where they are a map.
/// Errors of the writers (exchange/gltf, materialx, usd, u3m), with the preset and the document as `where`.
Result<std::vector<ExportedDocument>> write_documents(const ClothTextures& cloth, const ClothLayers& layers,
                                                      const std::filesystem::path& folder);

}  // namespace weft::exchange
