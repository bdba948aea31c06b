// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/product.h"
#include "core/base/result.h"
#include "material/assets/material_place.h"

// Materials of the library as calls name them. No path is made of what a client says.

namespace weft::app {

/// Its name without "library:", with ":" for "/".
std::string key_of(const material::MaterialPlace& place);

/// The material that has this key. kNoInput.
Result<material::MaterialPlace> library_material(const std::string& key);

/// Where it is built: beside its file, those of weft in the user's library.
std::filesystem::path builds_of(const material::MaterialPlace& place);

/// What was built of it, the oldest first. kNoInput.
Result<std::vector<Product>> list_builds(const std::string& key);

/// The one of this id; of an empty one the newest. kNoInput.
Result<Product> find_build(const std::string& key, const std::string& id);

}  // namespace weft::app
