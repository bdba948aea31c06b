// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// A material that differs from another by its layers, as a file of the user's library.
struct NewMaterialBody {
  std::string key;  ///< of the library
  std::filesystem::path file;
  std::string text;  ///< weft.material/1
};

/// The body of POST /api/v1/materials, which becomes a file in `folder`: {"name", "inherits": the key of a
/// material, "layers": [{"name", "alpha", "remove"}] from the bottom to the top}. Layers that it does not
/// name stay above those that it names. Nothing is written. kUsage with the field and its rule; kNoInput
/// where the other is not there; kCannotCreate where a material of this name is, unless it was made by this
/// call from the same one; what resolve_material() says of the result.
Result<NewMaterialBody> read_material_body(const Json& body, const std::filesystem::path& folder);

}  // namespace weft::app
