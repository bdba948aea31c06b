// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/material_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "app/server/api/bodies/library_materials.h"
#include "core/base/files.h"
#include "library/catalogue/session_name.h"
#include "material/assets/resolve.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNamedLayers = 64;

Error unfit_layer(const std::string& field, const std::string& rule) {
  return {ErrorKind::kUsage, "material cannot be read", field, rule, "see POST materials in openapi.json"};
}

Result<std::string> text_in(const Json& body, const char* field) {
  const auto value = body.find(field);
  if (value == body.end() || !value->is_string()) return unfit_layer(field, "must be a text");
  return value->get<std::string>();
}

// JSON's escapes are those of a basic string of TOML.
std::string toml_text(const std::string& text) {
  return Json(text).dump();
}

// Its first lines, by which a file that this call made is known again.
std::string head_of(const material::MaterialPlace& parent) {
  return fmt::format(
      "# Layers of another material, changed on the page.\nschema = \"weft.material/1\"\ninherits = {}\n",
      toml_text(parent.is_shipped() || parent.name.starts_with(material::kLibraryPrefix)
                    ? parent.name
                    : parent.file.string()));
}

struct LayerWish {
  std::string name;
  std::optional<double> alpha;
  bool removes = false;
};

Result<LayerWish> layer_in(const Json& layer) {
  if (!layer.is_object()) return unfit_layer("layers", "must be a list of objects");
  Result<std::string> name = text_in(layer, "name");
  if (!name) return unfit_layer("layers", "each must have a name");
  LayerWish wish = {std::move(*name), {}, false};
  for (const auto& [key, value] : layer.items()) {
    if (key == "alpha" && value.is_number() && value.get<double>() >= 0 && value.get<double>() <= 1) {
      wish.alpha = value.get<double>();
    } else if (key == "remove" && value.is_boolean()) {
      wish.removes = value.get<bool>();
    } else if (key != "name") {
      return unfit_layer("layers: " + key.substr(0, 40),
                         "a layer has a name, an alpha from 0 to 1, and remove true or false");
    }
  }
  return wish;
}

// Each above the one before it, so that their order is the wished one.
std::string text_of(const std::vector<LayerWish>& layers) {
  std::string text, below;
  for (const LayerWish& layer : layers) {
    text += fmt::format("\n[[layer]]\nname = {}\n", toml_text(layer.name));
    if (layer.removes) {
      text += "remove = true\n";
      continue;
    }
    if (layer.alpha) text += fmt::format("alpha = {}\n", *layer.alpha);
    if (!below.empty()) text += fmt::format("after = {}\n", toml_text(below));
    below = layer.name;
  }
  return text;
}

// As it would be once its file is there.
Result<void> check(const NewMaterialBody& material) {
  const material::MaterialPlace place = {std::string(material::kLibraryPrefix) + material.key, material.file};
  const Result<material::MaterialFile> file = material::parse_material(material.text, place);
  if (!file) return file.error();
  material::MaterialSource source = material::materials_on_disk();
  source.read = [&, otherwise =
                        source.read](const material::MaterialPlace& asked) -> Result<material::MaterialFile> {
    if (asked.file == place.file) return *file;
    return otherwise(asked);
  };
  const Result<material::ResolvedMaterial> resolved = material::resolve_material(place, source);
  if (!resolved) return resolved.error();
  return {};
}

}  // namespace

Result<NewMaterialBody> read_material_body(const Json& body, const fs::path& folder) {
  const Result<std::string> name = text_in(body, "name"), inherits = text_in(body, "inherits");
  if (!name) return name.error();
  if (!inherits) return inherits.error();
  if (!library::is_session_name(*name)) return unfit_layer("name", "must be a plain word");
  const Result<material::MaterialPlace> parent = library_material(*inherits);
  if (!parent) return parent.error();
  const auto list = body.find("layers");
  if (list == body.end() || !list->is_array() || list->size() > kMostNamedLayers)
    return unfit_layer("layers", fmt::format("must be a list of at most {}", kMostNamedLayers));
  std::vector<LayerWish> layers;
  for (const Json& each : *list) {
    Result<LayerWish> layer = layer_in(each);
    if (!layer) return std::move(layer).error();
    layers.push_back(std::move(*layer));
  }
  const std::string head = head_of(*parent);
  NewMaterialBody material = {*name, folder / (*name + ".toml"), head + text_of(layers)};
  if (is_there(material.file)) {
    const Result<std::string> there = read_text(material.file);
    if (!there || !there->starts_with(head))
      return Error{ErrorKind::kCannotCreate, "there is a material of this name already", *name,
                   "it was not made here from the same one", "choose another name"};
  }
  if (Result<void> ok = check(material); !ok) return std::move(ok).error();
  return material;
}

}  // namespace weft::app
