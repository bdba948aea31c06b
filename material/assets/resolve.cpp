// SPDX-License-Identifier: Apache-2.0
#include "material/assets/resolve.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "core/base/text.h"
#include "material/assets/map_set.h"
#include "material/assets/material_keys.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

using Layers = std::vector<MaterialLayer>;

std::string chain_of(const std::vector<MaterialPlace>& places, const MaterialPlace& last) {
  std::string chain;
  for (const MaterialPlace& place : places) chain += place.name + " -> ";
  return chain + last.name;
}

Error unfit(const MaterialPlace& place, const std::string& key, std::string why) {
  return unfit_material({place.name, {}}, key, std::move(why));
}

void override_values(KeptValues& values, const KeptValues& with) {
  for (const auto& [key, value] : with) values[key] = value;
}

Error no_layer(const MaterialPlace& place, const MaterialLayer& change, const Layers& layers,
               const std::string& wanted, const char* does) {
  const auto distance = [&](const MaterialLayer& each) { return edit_distance(wanted, each.name); };
  const auto nearest = std::ranges::min_element(layers, {}, distance);
  return unfit(place, "[[layer]] " + change.name,
               fmt::format("it {}, and there is no layer {} below{}", does, wanted,
                           nearest == layers.end() ? "" : "; the nearest is " + nearest->name));
}

// A layer that is changed, moved, taken out or new.
Result<void> apply(Layers& layers, const MaterialLayer& change, const MaterialPlace& place) {
  const auto there = std::ranges::find(layers, change.name, &MaterialLayer::name);
  if (change.removes) {
    if (there == layers.end()) return no_layer(place, change, layers, change.name, "is removed");
    layers.erase(there);
    return {};
  }
  MaterialLayer layer = change;
  layer.after.clear();
  if (there != layers.end()) {
    layer.values = there->values;
    override_values(layer.values, change.values);
    if (change.after.empty()) {
      *there = std::move(layer);
      return {};
    }
    layers.erase(there);
  } else if (!change.values.contains("material")) {
    return no_layer(place, change, layers, change.name, "names no material");
  }
  auto at = layers.end();
  if (!change.after.empty()) {
    at = std::ranges::find(layers, change.after, &MaterialLayer::name);
    if (at == layers.end()) return no_layer(place, change, layers, change.after, "stands after another");
    ++at;
  }
  layers.insert(at, std::move(layer));
  return {};
}

Result<void> unset(ResolvedMaterial& material, const std::string& key, const MaterialPlace& place) {
  const auto absent = [&] { return unfit(place, "unset", fmt::format("nothing below sets {}", key)); };
  if (key == "runtime") {
    if (material.runtime.empty() && material.runtime_layers.empty()) return absent();
    material.runtime.clear();
    material.runtime_layers.clear();
    return {};
  }
  const bool is_surface = key.starts_with("surface."), is_over = key.starts_with("over.");
  KeptValues& values = is_surface ? material.surface : is_over ? material.over : material.top;
  const std::string name = is_surface || is_over ? key.substr(key.find('.') + 1) : key;
  if (values.erase(name) == 0) return absent();
  return {};
}

// What a file says, on what its parent said.
Result<void> add_generation(ResolvedMaterial& material, const MaterialFile& file) {
  for (const std::string& key : file.unset) {
    if (Result<void> ok = unset(material, key, file.place); !ok) return ok;
  }
  override_values(material.top, file.top);
  override_values(material.surface, file.surface);
  override_values(material.over, file.over);
  for (const MaterialLayer& layer : file.layers) {
    if (Result<void> ok = apply(material.layers, layer, file.place); !ok) return ok;
  }
  override_values(material.runtime, file.runtime);
  for (const MaterialLayer& layer : file.runtime_layers) {
    if (Result<void> ok = apply(material.runtime_layers, layer, file.place); !ok) return ok;
  }
  if (material.runtime_layers.size() > static_cast<std::size_t>(kMostRuntimeLayers)) {
    return unfit(
        file.place, "[runtime]",
        fmt::format("there are {} layers with those inherited, and at most {} lie on the material itself",
                    material.runtime_layers.size(), kMostRuntimeLayers));
  }
  return {};
}

fs::path folder_of(const MaterialPlace& place) {
  return place.is_shipped() ? fs::path() : place.file.parent_path();
}

// Itself, its parent, and so on.
Result<std::vector<MaterialFile>> generations_of(const MaterialPlace& place, const MaterialSource& source) {
  std::vector<MaterialFile> files;
  std::vector<MaterialPlace> seen;
  MaterialPlace next = place;
  while (true) {
    if (std::ranges::find(seen, next) != seen.end())
      return unfit(place, "inherits", "materials inherit in a circle: " + chain_of(seen, next));
    if (seen.size() >= static_cast<std::size_t>(kMostGenerations))
      return unfit(
          place, "inherits",
          fmt::format("there are more than {} generations: {}", kMostGenerations, chain_of(seen, next)));
    Result<MaterialFile> file = source.read(next);
    if (!file) return std::move(file).error();
    seen.push_back(next);
    files.push_back(std::move(*file));
    const std::string& parent = files.back().inherits;
    if (parent.empty()) return files;
    if (next.is_shipped() && !parent.starts_with(kLibraryPrefix))
      return unfit(next, "inherits", "what weft brings along inherits only library: materials");
    Result<MaterialPlace> found = source.find(parent, folder_of(next));
    if (!found) {
      Error error = std::move(found).error();
      error.where = next.name + ": inherits: " + error.where;
      return error;
    }
    next = std::move(*found);
  }
}

void list_values(Json& list, const std::string& prefix, const KeptValues& values) {
  for (const auto& [key, value] : values)
    list.push_back({{"key", prefix + key}, {"value", value.value}, {"from", value.from}});
}

// The sets of maps that its own values come from, each once.
Json scans_in(const ResolvedMaterial& material) {
  Json scans = Json::array();
  std::set<std::string> seen;
  for (const KeptValues* values : {&material.surface, &material.over}) {
    for (const auto& [key, value] : *values) {
      if (!value.value.is_object() || !value.value.contains("scan")) continue;
      const std::string folder = value.value["scan"].get<std::string>();
      if (!seen.insert(folder).second) continue;
      const Result<MapSet> set = open_map_set(folder, true);
      if (Json source = set ? source_of(*set) : Json(); !source.is_null()) scans.push_back(std::move(source));
    }
  }
  return scans;
}

}  // namespace

MaterialSource materials_on_disk() {
  return {find_material, [](const MaterialPlace& place) -> Result<MaterialFile> {
            Result<MaterialFile> file = read_material(place);
            if (!file) return file;
            if (Result<void> ok = expand_scan(*file); !ok) return std::move(ok).error();
            return file;
          }};
}

Result<ResolvedMaterial> resolve_material(const MaterialPlace& place, const MaterialSource& source) {
  const Result<std::vector<MaterialFile>> files = generations_of(place, source);
  if (!files) return files.error();
  ResolvedMaterial material;
  material.place = place;
  for (auto file = files->rbegin(); file != files->rend(); ++file) {
    if (Result<void> ok = add_generation(material, *file); !ok) return std::move(ok).error();
  }
  for (const MaterialFile& file : *files) material.generations.push_back(file.place);
  return material;
}

Json json_of(const ResolvedMaterial& material) {
  Json values = Json::array(), generations = Json::array();
  list_values(values, "", material.top);
  list_values(values, "surface.", material.surface);
  for (const MaterialLayer& layer : material.layers)
    list_values(values, "layer." + layer.name + ".", layer.values);
  list_values(values, "over.", material.over);
  list_values(values, "runtime.", material.runtime);
  for (const MaterialLayer& layer : material.runtime_layers)
    list_values(values, "runtime.layer." + layer.name + ".", layer.values);
  for (const MaterialPlace& place : material.generations) generations.push_back(place.name);
  return {{"schema", "weft.material-resolved/1"},
          {"material", material.place.name},
          {"generations", std::move(generations)},
          {"values", std::move(values)},
          {"scans", scans_in(material)}};
}

}  // namespace weft::material
