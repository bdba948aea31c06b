// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "material/assets/material_file.h"

namespace weft::material {

/// A material with all that it inherits.
struct ResolvedMaterial {
  MaterialPlace place;
  KeptValues top, surface, over;
  std::vector<MaterialLayer> layers;  ///< bottom to top, each with its material
  KeptValues runtime;
  std::vector<MaterialLayer> runtime_layers;
  std::vector<MaterialPlace> generations;  ///< itself, its parent, and so on
};

/// Where materials come from: files, or a test's memory.
struct MaterialSource {
  std::function<Result<MaterialPlace>(const std::string& written, const std::filesystem::path& folder)> find;
  std::function<Result<MaterialFile>(const MaterialPlace& place)> read;
};
/// find_material(), and read_material() with what a scan at its top stands for.
MaterialSource materials_on_disk();

/// Values override key by key, layers by name; `unset` goes before what the same file says. kBadData with the
/// chain for parents in a circle or more than kMostGenerations, for a layer that is changed or removed and
/// not there, a new one without a material, and a key unset that is not there. Errors of the source.
Result<ResolvedMaterial> resolve_material(const MaterialPlace& place, const MaterialSource& source);

/// {"schema": "weft.material-resolved/1", "material", "generations", "values": [{"key", "value", "from"}],
/// "scans"}: every value with the file that it comes from, and the solves that its own maps are of.
Json json_of(const ResolvedMaterial& material);

}  // namespace weft::material
