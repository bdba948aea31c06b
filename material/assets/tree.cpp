// SPDX-License-Identifier: Apache-2.0
#include "material/assets/tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/product.h"
#include "material/assets/material_keys.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr double kSquare = 0.01;
constexpr int kMostSide = 32768;
constexpr std::size_t kDeepest = 64;

Error unfit(const MaterialNode& node, const std::string& key, std::string why) {
  return unfit_material({node.material.place.name, {}}, key, std::move(why));
}

// "FILE: key" of a kept value.
std::string where_of(const KeptValue& value, const std::string& key) {
  return value.from + ": " + key;
}

class TreeBuilder {
 public:
  TreeBuilder(const MaterialSource& source, DigestCache& digests) : source_(source), digests_(digests) {}

  Result<std::size_t> add(const MaterialPlace& place) {
    const auto known = done_.find(place.name);
    if (known != done_.end()) return known->second;
    if (std::ranges::find(under_way_, place) != under_way_.end()) {
      std::string chain;
      for (const MaterialPlace& each : under_way_) chain += each.name + " -> ";
      return unfit_material({place.name, {}}, "[[layer]]",
                            "layers lie on each other in a circle: " + chain + place.name);
    }
    if (under_way_.size() >= kDeepest)
      return unfit_material({place.name, {}}, "[[layer]]",
                            fmt::format("layers of layers are more than {} deep", kDeepest));
    under_way_.push_back(place);
    Result<MaterialNode> node = node_of(place);
    under_way_.pop_back();
    if (!node) return std::move(node).error();
    tree_.nodes.push_back(std::move(*node));
    return done_[place.name] = tree_.nodes.size() - 1;
  }

  MaterialTree take(std::vector<std::size_t> roots) {
    tree_.roots = std::move(roots);
    return std::move(tree_);
  }

 private:
  Result<MaterialNode> node_of(const MaterialPlace& place) {
    Result<ResolvedMaterial> material = resolve_material(place, source_);
    if (!material) return std::move(material).error();
    MaterialNode node;
    node.material = std::move(*material);
    node.name = name_of_node(node.material);
    for (const auto step : {&TreeBuilder::find_layers, &TreeBuilder::find_maps, &TreeBuilder::find_grid,
                            &TreeBuilder::find_fits, &TreeBuilder::check_masks, &TreeBuilder::find_id}) {
      if (Result<void> ok = (this->*step)(node); !ok) return std::move(ok).error();
    }
    return node;
  }

  static std::string name_of_node(const ResolvedMaterial& material) {
    const auto name = material.top.find("name");
    // A name is its own file's, not its parent's.
    if (name != material.top.end() && name->second.from == material.place.name)
      return name->second.value.get<std::string>();
    return fs::path(material.place.name.substr(material.place.name.rfind(':') + 1)).stem().string();
  }

  Result<std::size_t> layer_node(const MaterialLayer& layer) {
    const KeptValue& written = layer.values.at("material");
    const Result<MaterialPlace> place = source_.find(written.value.get<std::string>(), {});
    if (!place) {
      Error error = place.error();
      error.where = where_of(written, "[[layer]] " + layer.name + ": material: " + error.where);
      return error;
    }
    return add(*place);
  }

  Result<void> find_layers(MaterialNode& node) {
    for (const MaterialLayer& layer : node.material.layers) {
      const Result<std::size_t> found = layer_node(layer);
      if (!found) return found.error();
      node.layers.push_back(*found);
    }
    for (const MaterialLayer& layer : node.material.runtime_layers) {
      if (!layer.values.contains("material"))
        return unfit(node, "[[runtime.layer]] " + layer.name, "it names no material");
      const Result<std::size_t> found = layer_node(layer);
      if (!found) return found.error();
      node.runtime.push_back(*found);
    }
    return {};
  }

  static Result<void> keep(MaterialNode& node, const std::string& key, Result<MapFile> map) {
    if (!map) return std::move(map).error();
    node.maps[key] = std::move(*map);
    return {};
  }

  Result<void> find_maps(MaterialNode& node) {
    for (const auto& [table, values] :
         {std::pair{"surface", &node.material.surface}, std::pair{"over", &node.material.over}}) {
      for (const auto& [name, value] : *values) {
        if (!value.value.is_object()) continue;
        const std::string key = fmt::format("{}.{}", table, name);
        if (Result<void> ok =
                keep(node, key, find_map(*parameter_named(name), value.value, where_of(value, key)));
            !ok)
          return ok;
      }
    }
    for (const MaterialLayer& layer : node.material.layers) {
      const auto mask = layer.values.find("mask");
      if (mask == layer.values.end() || !mask->second.value.contains("map")) continue;
      const std::string key = "layer." + layer.name + ".mask";
      if (Result<void> ok = keep(node, key, find_mask(mask->second.value, where_of(mask->second, key))); !ok)
        return ok;
    }
    const auto weights = node.material.runtime.find("weights");
    if (weights == node.material.runtime.end() || !weights->second.value.is_object()) return {};
    return keep(node, "runtime.weights",
                find_mask(weights->second.value, where_of(weights->second, "runtime.weights")));
  }

  // The size in pixels and millimetres: of its own maps, as it says, or of its lowest layer that has maps.
  Result<void> find_grid(MaterialNode& node) {
    std::string first;
    for (const auto& [key, map] : node.maps) {
      const bool is_own = key.starts_with("surface.") || key.starts_with("over.");
      if (!is_own || map.same) continue;
      if (first.empty()) {
        first = key;
        node.size = map.size;
        node.is_tile = map.is_tile;
        node.size_mm = map.size_mm;
        node.is_size_known = map.is_size_known;
      } else if (!(map.size == node.size)) {
        return unfit(node, key,
                     fmt::format("it has {} x {} pixels, and {} has {} x {}", map.size.width, map.size.height,
                                 first, node.size.width, node.size.height));
      }
    }
    node.has_map = !first.empty();
    const auto& top = node.material.top;
    if (top.contains("size_mm")) {
      const Json& mm = top.at("size_mm").value;
      node.size_mm = {{mm[0].get<double>(), mm[1].get<double>()}};
      node.is_size_known = true;
    }
    if (top.contains("is_tile")) node.is_tile = top.at("is_tile").value.get<bool>();
    if (top.contains("pixels")) {
      const Json& asked = top.at("pixels").value;
      const Size size = {asked[0].get<int>(), asked[1].get<int>()};
      if (node.has_map && !(size == node.size))
        return unfit(node, "pixels",
                     fmt::format("{} x {} are asked for, and {} has {} x {}", size.width, size.height, first,
                                 node.size.width, node.size.height));
      node.size = size;
    }
    return grid_of_layers(node);
  }

  Result<void> grid_of_layers(MaterialNode& node) {
    for (std::size_t i = 0; i < node.layers.size(); ++i) {
      const MaterialNode& layer = tree_.nodes[node.layers[i]];
      if (!layer.has_map) continue;
      node.has_map = true;
      if (!node.size_mm && layer.size_mm) {
        node.size_mm = layer.size_mm;
        node.is_size_known = layer.is_size_known;
      }
      if (node.size.width != 0 || !node.size_mm || !layer.size_mm) continue;
      const auto pixels = [&](std::size_t axis, int of_layer) {
        return static_cast<int>(
            std::clamp(std::round((*node.size_mm)[axis] / (*layer.size_mm)[axis] * of_layer), 1.0, 1e6));
      };
      node.size = {pixels(0, layer.size.width), pixels(1, layer.size.height)};
    }
    for (const auto& [key, map] : node.maps) {
      if (map.same) continue;
      node.has_map = true;
      if (node.size.width == 0) node.size = map.size;
    }
    if (node.size.width == 0) node.size = {kPlainSide, kPlainSide};
    if (node.size.width > kMostSide || node.size.height > kMostSide)
      return unfit(node, "pixels",
                   fmt::format("{} x {} pixels are more than {} a side; say pixels or size_mm",
                               node.size.width, node.size.height, kMostSide));
    if (!node.size_mm || !node.has_map) return {};
    const double across = (*node.size_mm)[0] / node.size.width, down = (*node.size_mm)[1] / node.size.height;
    if (std::abs(across / down - 1) > kSquare)
      return unfit(node, "size_mm",
                   fmt::format("pixels would be {:.4g} mm wide and {:.4g} mm high; they must be square",
                               across, down));
    return {};
  }

  static std::array<double, 2> pair_of(const MaterialLayer& layer, const char* key) {
    const auto found = layer.values.find(key);
    if (found == layer.values.end()) return {};
    return {found->second.value[0].get<double>(), found->second.value[1].get<double>()};
  }

  Result<void> find_fits(MaterialNode& node) {
    for (std::size_t i = 0; i < node.layers.size(); ++i) {
      const MaterialNode& below = tree_.nodes[node.layers[i]];
      const MaterialLayer& layer = node.material.layers[i];
      const auto turn = layer.values.find("turn_deg");
      const int quarters = turn == layer.values.end()
                               ? 0
                               : static_cast<int>(std::lround(turn->second.value.get<double>() / 90));
      if (!below.has_map) {
        node.fits.emplace_back(LayerFit{.quarter_turns = ((quarters % 4) + 4) % 4});
        continue;
      }
      Result<LayerFit> fit = fit_layer({.layer_mm = below.size_mm.value_or(std::array<double, 2>{}),
                                        .below_mm = node.size_mm.value_or(std::array<double, 2>{}),
                                        .repeat_mm = pair_of(layer, "tile_mm"),
                                        .offset_mm = pair_of(layer, "offset_mm"),
                                        .quarter_turns = quarters,
                                        .below = node.size},
                                       node.is_tile);
      if (!fit) {
        Error error = unfit(node, "[[layer]] " + layer.name, fit.error().why);
        error.remedy = fit.error().remedy;
        return error;
      }
      // A cloth that is no tile and lies once has a border that ends there.
      fit->wraps = below.is_tile || fit->across > 1 || fit->down > 1 || node.is_tile;
      node.fits.emplace_back(*fit);
    }
    return {};
  }

  // Whether a layer says something of the height.
  static bool reaches_height(const MaterialLayer& layer) {
    const auto only = layer.values.find("only");
    return only == layer.values.end() ||
           std::ranges::find(only->second.value, Json("height_mm")) != only->second.value.end();
  }

  Result<void> check_masks(MaterialNode& node) {
    const auto own = node.maps.find("surface.height_mm");
    bool has_relief = own != node.maps.end() && !own->second.same;
    for (std::size_t i = 0; i < node.layers.size(); ++i) {
      const MaterialLayer& layer = node.material.layers[i];
      const auto mask = layer.values.find("mask");
      if (mask != layer.values.end() && mask->second.value.contains("from")) {
        const std::string key = "layer." + layer.name + ".mask";
        const Json& rule = mask->second.value;
        if (!has_relief)
          return unfit_material(
              {mask->second.from, {}}, key,
              "it follows the height, and nothing below has one; make it with weft maps --maps height");
        if (rule["kind"] == "cavity" && node.mm_per_pixel() == 0)
          return unfit_material({mask->second.from, {}}, key,
                                "its radius is in millimetres, and size_mm is not known");
        if (rule["kind"] == "cavity" && rule.value("radius_mm", 0.5) < node.mm_per_pixel())
          return unfit_material(
              {mask->second.from, {}}, key,
              fmt::format("radius_mm is under a pixel, which is {:.4g} mm", node.mm_per_pixel()));
      }
      has_relief = has_relief || (tree_.nodes[node.layers[i]].has_relief && reaches_height(layer));
    }
    const auto over = node.maps.find("over.height_mm");
    node.has_relief = has_relief || (over != node.maps.end() && !over->second.same);
    return {};
  }

  // What of a file's meaning lies beside it, as in an export.json.
  static Json meaning_json(const MapFile& map) {
    Json json = {{"unit", map.unit}, {"y_is_down", map.y_is_down}};
    if (map.scale) json["scale"] = *map.scale;
    if (map.offset) json["offset"] = *map.offset;
    if (map.is_srgb) json["is_srgb"] = *map.is_srgb;
    return json;
  }

  // A value without its paths, with the digest of what it names.
  Result<Json> identity(const MaterialNode& node, const std::string& key, const Json& value) {
    const auto map = node.maps.find(key);
    if (map == node.maps.end()) return value;
    Json facts = value;
    facts.erase("map");
    facts.erase("scan");
    facts.erase("draft");
    if (map->second.same) {
      facts["same"] = *map->second.same;
    } else {
      Result<std::string> sha256 = digests_.digest(map->second.file);
      if (!sha256) return std::move(sha256).error();
      facts["sha256"] = std::move(*sha256);
    }
    facts["channels"] = map->second.channels;
    facts["read_as"] = meaning_json(map->second);
    facts["source"] = map->second.source;
    facts["from"] = map->second.provenance;
    return facts;
  }

  Result<Json> identities(const MaterialNode& node, const std::string& prefix, const KeptValues& values) {
    Json all = Json::object();
    for (const auto& [name, value] : values) {
      if (name == "material") continue;
      Result<Json> facts = identity(node, prefix + name, value.value);
      if (!facts) return facts;
      all[name] = std::move(*facts);
    }
    return all;
  }

  Result<Json> layers_json(const MaterialNode& node, const std::vector<MaterialLayer>& layers,
                           const std::vector<std::size_t>& nodes, const std::string& prefix) {
    Json list = Json::array();
    for (std::size_t i = 0; i < layers.size(); ++i) {
      Result<Json> facts = identities(node, prefix + layers[i].name + ".", layers[i].values);
      if (!facts) return facts;
      const MaterialNode& of = tree_.nodes[nodes[i]];
      list.push_back(
          {{"name", layers[i].name}, {"material", of.id}, {"of", of.name}, {"values", std::move(*facts)}});
    }
    return list;
  }

  Result<void> find_id(MaterialNode& node) {
    node.inputs = {{"builder", kMaterialBuilder},
                   {"name", node.name},
                   {"width", node.size.width},
                   {"height", node.size.height},
                   {"is_tile", node.is_tile}};
    if (node.size_mm) node.inputs["size_mm"] = *node.size_mm;
    if (!node.is_size_known) node.inputs["size_known"] = false;
    const ResolvedMaterial& material = node.material;
    for (const auto& [table, values] :
         {std::pair{"surface", &material.surface}, std::pair{"over", &material.over},
          std::pair{"runtime", &material.runtime}}) {
      Result<Json> facts = identities(node, std::string(table) + ".", *values);
      if (!facts) return std::move(facts).error();
      node.inputs[table] = std::move(*facts);
    }
    Result<Json> layers = layers_json(node, material.layers, node.layers, "layer.");
    if (!layers) return std::move(layers).error();
    node.inputs["layers"] = std::move(*layers);
    Result<Json> runtime = layers_json(node, material.runtime_layers, node.runtime, "runtime.layer.");
    if (!runtime) return std::move(runtime).error();
    node.inputs["runtime_layers"] = std::move(*runtime);
    node.id = product_id(node.inputs);
    return {};
  }

  const MaterialSource& source_;
  DigestCache& digests_;
  MaterialTree tree_;
  std::map<std::string, std::size_t> done_;
  std::vector<MaterialPlace> under_way_;
};

}  // namespace

Result<MaterialTree> plan_materials(const std::vector<MaterialPlace>& roots, const MaterialSource& source,
                                    DigestCache& digests) {
  TreeBuilder builder(source, digests);
  std::vector<std::size_t> nodes;
  for (const MaterialPlace& root : roots) {
    const Result<std::size_t> node = builder.add(root);
    if (!node) return node.error();
    nodes.push_back(*node);
  }
  return builder.take(std::move(nodes));
}

Json scans_of(const MaterialTree& tree, std::size_t index) {
  Json scans = Json::array();
  const auto add = [&](Json scan) {
    const bool is_new = std::ranges::none_of(scans, [&](const Json& each) { return each == scan; });
    if (is_new) scans.push_back(std::move(scan));
  };
  const MaterialNode& node = tree.nodes[index];
  for (const auto& [key, map] : node.maps) {
    if (!map.is_of_scan || !map.provenance.contains("solve")) continue;
    Json scan = map.provenance;
    for (const char* other : {"map", "rectified"}) scan.erase(other);
    if (!map.stale.empty()) scan["stale"] = map.stale;
    add(std::move(scan));
  }
  for (const std::vector<std::size_t>* below : {&node.layers, &node.runtime}) {
    for (const std::size_t each : *below) {
      for (Json& scan : scans_of(tree, each)) add(std::move(scan));
    }
  }
  return scans;
}

std::vector<fs::path> files_of(const MaterialTree& tree) {
  std::set<fs::path> files;
  for (const MaterialNode& node : tree.nodes) {
    for (const MaterialPlace& place : node.material.generations) {
      if (!place.is_shipped()) files.insert(place.file);
    }
    for (const auto& [key, map] : node.maps) {
      if (!map.file.empty()) files.insert(map.file);
    }
  }
  return {files.begin(), files.end()};
}

}  // namespace weft::material
