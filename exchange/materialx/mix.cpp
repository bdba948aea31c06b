// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>

#include "exchange/materialx/mtlx_document.h"
#include "exchange/materialx/mtlx_surface.h"

namespace weft::exchange {

namespace {

Error bad_mix(const std::string& where, const std::string& why, const std::string& remedy) {
  return {ErrorKind::kBadData, "the layers cannot be mixed", where, why, remedy};
}

Result<void> check_layers(std::span<const TexturedMaterial> layers, const RuntimeWeights& weights) {
  if (layers.empty() || layers.size() > 4) {
    return bad_mix("layers", std::to_string(layers.size()) + " are not 1 to 4", "bake some of them first");
  }
  for (const TexturedMaterial& layer : layers) {
    if (auto checked = check_material(layer); !checked) {
      Error error = checked.error();
      error.where = layer.name + ": " + error.where;
      return error;
    }
    if (layer.size_mm.has_value() != layers.front().size_mm.has_value()) {
      return bad_mix(layer.name, "some layers have a size and some none, so they have no common scale",
                     "give size_mm to all of them or to none");
    }
  }
  if (!weights.texture) return {};
  const Texture& texture = *weights.texture;
  if (auto path = check_portable_path(texture.file); !path) return path;
  if (texture.channels != "rgb" || texture.is_srgb || texture.scale != 1 || texture.offset != 0) {
    return bad_mix("weights", "they are no linear image with the channels rgb, without scale and offset",
                   "write the weights into R, G and B");
  }
  return {};
}

/// Weights of the second layer and those above it.
std::vector<MtlxValue> weights_in(MtlxGraph& graph, const RuntimeWeights& weights, std::size_t layers) {
  std::vector<MtlxValue> values;
  if (layers < 2) return values;
  const MtlxValue all = weights.texture ? graph.vector_texels("weights", *weights.texture)
                                        : graph.node("vertex_colors", "geomcolor", "color3", {});
  for (std::size_t i = 1; i < layers; ++i) {
    const MtlxValue index = {"integer", "", {static_cast<double>(i - 1)}};
    values.push_back(
        graph.node("weight_" + std::to_string(i + 1), "extract", "float", {{"in", all}, {"index", index}}));
    graph.output(values.back());
  }
  return values;
}

void write_mix(XmlWriter& xml, const std::string& name, const std::string& top, const std::string& below,
               const MtlxGraph& weights, const MtlxValue& weight) {
  xml.open("mix", {{"name", name}, {"type", "surfaceshader"}});
  xml.leaf("input", {{"name", "fg"}, {"type", "surfaceshader"}, {"nodename", top}});
  xml.leaf("input", {{"name", "bg"}, {"type", "surfaceshader"}, {"nodename", below}});
  xml.leaf(
      "input",
      {{"name", "mix"}, {"type", "float"}, {"nodegraph", weights.name()}, {"output", "out_" + weight.node}});
  xml.close();
}

std::vector<std::pair<std::string, std::string>> provenance_of(std::span<const TexturedMaterial> layers) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const TexturedMaterial& layer : layers) {
    for (const auto& [key, value] : layer.provenance) all.emplace_back(layer.name + ": " + key, value);
  }
  return all;
}

void append_new(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& each : more) {
    if (std::ranges::find(all, each) == all.end()) all.push_back(each);
  }
}

}  // namespace

Result<Document> materialx_mix_of(const std::string& name, std::span<const TexturedMaterial> layers,
                                  const RuntimeWeights& weights, const MaterialXOptions& options) {
  if (name.empty() || !is_plain_text(name)) {
    return bad_mix("name", "it is empty, or no UTF-8 without control characters", "name the material");
  }
  if (auto checked = check_layers(layers, weights); !checked) return checked.error();
  const auto& bottom = layers.front();
  if (auto checked = check_materialx_options(options, bottom.size_mm.has_value()); !checked) {
    return checked.error();
  }
  const auto uv_covers_mm = options.uv_covers_mm ? options.uv_covers_mm : bottom.size_mm;
  const std::string identifier = identifier_of(name);
  MtlxGraph weight_graph("NG_" + identifier + "_weights", std::nullopt);
  const auto weight = weights_in(weight_graph, weights, layers.size());
  std::deque<MtlxGraph> graphs;
  std::vector<MtlxSurface> surfaces;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    names.push_back(identifier + "_" + std::to_string(i + 1) + "_" + identifier_of(layers[i].name));
    graphs.emplace_back("NG_" + names.back(), scale_of(layers[i], uv_covers_mm));
    surfaces.emplace_back(layers[i], options.models.front(), graphs.back()).prepare();
  }

  XmlWriter xml;
  open_document(xml, name, provenance_of(layers), size_note_of(bottom));
  for (const MtlxGraph& graph : graphs) graph.write(xml);
  weight_graph.write(xml);
  Document document;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    surfaces[i].write(xml, "SR_" + names[i]);
    append_new(document.files, graphs[i].files());
    append_new(document.left_out, surfaces[i].left_out());
    if (layers[i].height_mm) {
      append_new(document.left_out, {"height_mm: layers are mixed as surfaces, without displacement"});
    }
  }
  append_new(document.files, weight_graph.files());
  std::string mixed = "SR_" + names[0];
  for (std::size_t i = 1; i < layers.size(); ++i) {
    const std::string next = "mix_" + std::to_string(i + 1) + "_" + identifier;
    write_mix(xml, next, "SR_" + names[i], mixed, weight_graph, weight[i - 1]);
    mixed = next;
  }
  write_material(xml, identifier, mixed, "");
  xml.close();
  document.bytes = xml.text();
  return document;
}

}  // namespace weft::exchange
