// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::material {

/// A built material that is mixed while it is drawn.
struct RuntimeLayer {
  std::string name;              ///< of the layer; of the lowest one that of its material
  std::string id;                ///< of the built material
  std::filesystem::path folder;  ///< with its material.json
  std::string channel;           ///< of the weights: "r", "g", "b"; empty: lies below all
};

/// The layers of a built material that has [runtime], bottom to top and itself first, as materialx_mix_of()
/// takes them. Empty where it has none. kNoInput where one is not built; kBadData.
struct RuntimeStack {
  std::string weights;  ///< "vertex-color", or the file of its weights in the lowest one's folder
  std::vector<RuntimeLayer> layers;
};
Result<RuntimeStack> runtime_stack_of(const std::filesystem::path& built);

/// layers.json (weft.layers/1), for engines: where the weights come from, and for each layer its channel and
/// the files that were packed of it. `files`: by the id of a built material.
Json layers_json(const RuntimeStack& stack, const std::map<std::string, std::vector<std::string>>& files);

}  // namespace weft::material
