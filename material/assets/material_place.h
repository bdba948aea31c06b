// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace weft::material {

/// Before the name of a material that weft brings along, or that lies in the user's own library.
inline constexpr std::string_view kLibraryPrefix = "library:";

/// A material that weft brings along: material/templates/NAME.toml.
struct ShippedMaterial {
  const char* name;  ///< "cloth/cotton"
  const char* text;
};
const std::vector<ShippedMaterial>& shipped_materials();

/// Where a material stands.
struct MaterialPlace {
  std::string name;                 ///< for messages and lists: "library:cloth/cotton", or its file
  std::filesystem::path file = {};  ///< absolute; empty: shipped

  bool is_shipped() const { return file.empty(); }
  friend bool operator==(const MaterialPlace& a, const MaterialPlace& b) {
    return a.name == b.name && a.file == b.file;
  }
};

/// $XDG_DATA_HOME/weft/materials, else ~/.local/share/weft/materials.
std::filesystem::path user_materials_folder();

/// A material by the name that another writes, whose folder a relative file starts from. `library:` names are
/// those of the user's folder first, then of what weft brings along: the whole name, or its last part where
/// only one ends so. kNoInput where there is none, with the nearest; kBadData where two end so.
Result<MaterialPlace> find_material(const std::string& written, const std::filesystem::path& folder);

/// The user's own, and those of weft that none of them hides, by name.
std::vector<MaterialPlace> list_materials();

/// The text of a file, or of what weft brings along. kNoInput.
Result<std::string> material_text(const MaterialPlace& place);

}  // namespace weft::material
