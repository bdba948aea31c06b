// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/library_materials.h"

#include <algorithm>
#include <utility>

#include "material/assets/build.h"
#include "material/assets/resolve.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// As its material.json calls it.
std::string name_in_builds(const material::MaterialPlace& place) {
  const Result<material::ResolvedMaterial> resolved =
      material::resolve_material(place, material::materials_on_disk());
  if (resolved) {
    const auto name = resolved->top.find("name");
    if (name != resolved->top.end() && name->second.from == place.name && name->second.value.is_string())
      return name->second.value.get<std::string>();
  }
  return fs::path(place.name.substr(place.name.rfind(':') + 1)).stem().string();
}

Error no_such_build(const std::string& id) {
  return {ErrorKind::kNoInput, "there is no such build", id.substr(0, 40), "",
          "see the list of those that the material has, or build it"};
}

}  // namespace

std::string key_of(const material::MaterialPlace& place) {
  std::string key = place.name;
  if (key.starts_with(material::kLibraryPrefix)) key.erase(0, material::kLibraryPrefix.size());
  std::ranges::replace(key, '/', ':');
  return key;
}

Result<material::MaterialPlace> library_material(const std::string& key) {
  for (material::MaterialPlace& place : material::list_materials()) {
    if (key_of(place) == key) return std::move(place);
  }
  return Error{ErrorKind::kNoInput, "there is no such material", key.substr(0, 40), "",
               "see GET materials for those of the library"};
}

fs::path builds_of(const material::MaterialPlace& place) {
  return place.is_shipped() ? material::user_materials_folder() / "build" : material::build_folder_of(place);
}

Result<std::vector<Product>> list_builds(const std::string& key) {
  const Result<material::MaterialPlace> place = library_material(key);
  if (!place) return place.error();
  const std::string name = name_in_builds(*place);
  std::vector<Product> builds;
  for (Product& product : list_products(material::kMaterialProduct, builds_of(*place))) {
    const Result<std::optional<Json>> document = find_finished(product);
    if (document && *document && (*document)->value("name", Json()) == Json(name))
      builds.push_back(std::move(product));
  }
  return builds;
}

Result<Product> find_build(const std::string& key, const std::string& id) {
  Result<std::vector<Product>> builds = list_builds(key);
  if (!builds) return std::move(builds).error();
  if (id.empty() && !builds->empty()) return std::move(builds->back());
  const auto found = std::ranges::find(*builds, id, &Product::id);
  if (found == builds->end()) return no_such_build(id);
  return std::move(*found);
}

}  // namespace weft::app
