// SPDX-License-Identifier: Apache-2.0
#include "exchange/materialx/materialx.h"

#include <algorithm>

#include "exchange/materialx/mtlx_document.h"
#include "exchange/materialx/mtlx_surface.h"

namespace weft::exchange {

const char* name_of(SurfaceModel model) {
  static constexpr std::array<const char*, 3> kNames = {"open_pbr_surface", "standard_surface", "gltf_pbr"};
  return kNames[static_cast<std::size_t>(model)];
}

Result<void> check_materialx_options(const MaterialXOptions& options, bool has_size) {
  const auto bad = [](const char* where, const char* why, const char* remedy) {
    return Error{ErrorKind::kBadData, "the MaterialX document cannot be written", where, why, remedy};
  };
  if (options.models.empty()) return bad("models", "none is asked for", "ask for open_pbr_surface");
  for (const SurfaceModel model : options.models) {
    if (std::ranges::count(options.models, model) == 1) continue;
    return bad("models", "one is asked for twice", "ask for each once");
  }
  if (!options.uv_covers_mm) return {};
  if (!has_size) return bad("uv_covers_mm", "the size of the cloth is not known", "leave it out");
  const auto& covers = *options.uv_covers_mm;
  const bool is_positive = covers[0] > 0 && covers[1] > 0 && covers[0] < 1e9 && covers[1] < 1e9;
  return is_positive ? Result<void>() : bad("uv_covers_mm", "it is not above 0", "give millimetres");
}

std::optional<MtlxGraph::Scale> scale_of(const TexturedMaterial& material,
                                         const std::optional<std::array<double, 2>>& uv_covers_mm) {
  if (!material.size_mm) return std::nullopt;
  const auto& image = *material.size_mm;
  const auto uv = uv_covers_mm.value_or(image);
  return MtlxGraph::Scale{{image[0] / 1000, image[1] / 1000}, {uv[0] / 1000, uv[1] / 1000}};
}

void open_document(XmlWriter& xml, const std::string& name,
                   const std::vector<std::pair<std::string, std::string>>& provenance,
                   const std::string& size_note) {
  std::string words = name + "; " + size_note;
  for (const auto& [key, value] : provenance) words += "; " + key + " " + value;
  xml.open("materialx", {{"version", "1.39"}, {"colorspace", "lin_rec709"}, {"doc", words}});
}

std::string size_note_of(const TexturedMaterial& material) {
  if (!material.size_mm) return "size not known";
  const std::string size = "size_mm " + numbers_text({(*material.size_mm)[0], (*material.size_mm)[1]});
  return material.is_size_known ? size : size + ", assumed: the size is not known";
}

void write_material(XmlWriter& xml, const std::string& name, const std::string& shader,
                    const std::string& displacement) {
  xml.open("surfacematerial", {{"name", name}, {"type", "material"}});
  xml.leaf("input", {{"name", "surfaceshader"}, {"type", "surfaceshader"}, {"nodename", shader}});
  if (!displacement.empty()) {
    xml.leaf("input",
             {{"name", "displacementshader"}, {"type", "displacementshader"}, {"nodename", displacement}});
  }
  xml.close();
}

std::string write_displacement(XmlWriter& xml, const MtlxGraph& graph, const MtlxValue& height) {
  const std::string name = "displacement_" + graph.name();
  xml.open("displacement", {{"name", name}, {"type", "displacementshader"}});
  xml.leaf("input", {{"name", "displacement"},
                     {"type", "float"},
                     {"nodegraph", graph.name()},
                     {"output", "out_" + height.node}});
  xml.leaf("input", {{"name", "scale"}, {"type", "float"}, {"value", "0.001"}});
  xml.close();
  return name;
}

Result<Document> materialx_of(const TexturedMaterial& material, const MaterialXOptions& options) {
  if (auto checked = check_material(material); !checked) return checked.error();
  if (auto checked = check_materialx_options(options, material.size_mm.has_value()); !checked) {
    return checked.error();
  }
  const std::string identifier = identifier_of(material.name);
  MtlxGraph graph("NG_" + identifier, scale_of(material, options.uv_covers_mm));
  std::vector<MtlxSurface> surfaces;
  for (const SurfaceModel model : options.models) surfaces.emplace_back(material, model, graph).prepare();
  const bool displaces = options.has_displacement && material.height_mm && material.height_mm->texture;
  const MtlxValue height = displaces ? graph.scalar("height", *material.height_mm->texture) : mtlx_float(0);
  if (displaces) graph.output(height);

  XmlWriter xml;
  open_document(xml, material.name, material.provenance, size_note_of(material));
  graph.write(xml);
  const std::string displacement = displaces ? write_displacement(xml, graph, height) : "";
  Document document = {"", graph.files(), {}};
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const std::string name = i == 0 ? identifier : identifier + "_" + name_of(options.models[i]);
    surfaces[i].write(xml, "SR_" + name);
    write_material(xml, name, "SR_" + name, displacement);
    const auto& left_out = surfaces[i].left_out();
    document.left_out.insert(document.left_out.end(), left_out.begin(), left_out.end());
  }
  xml.close();
  if (material.height_mm && !displaces) {
    document.left_out.push_back("height_mm: no displacement was asked for, the normals show the relief");
  }
  document.bytes = xml.text();
  return document;
}

}  // namespace weft::exchange
