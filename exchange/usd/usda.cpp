// SPDX-License-Identifier: Apache-2.0
#include "exchange/plane.h"
#include "exchange/usd/usd.h"
#include "exchange/usd/usda_text.h"

namespace weft::exchange {

std::string usda_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string usda_asset(std::string_view path) {
  const bool has_mark = path.find('@') != std::string_view::npos;
  const std::string mark = has_mark ? "@@@" : "@";
  return mark + std::string(path) + mark;
}

std::string usda_tuple(const std::vector<double>& values) {
  return "(" + numbers_text(values) + ")";
}

namespace {

void write_layer_data(UsdaWriter& usda, const TexturedMaterial& material, const std::string& root) {
  usda.line("#usda 1.0");
  usda.begin_list("(");
  usda.begin_list("customLayerData = {");
  usda.begin_list("dictionary weft = {");
  if (material.size_mm) {
    usda.line("double2 size_mm = " + usda_tuple({(*material.size_mm)[0], (*material.size_mm)[1]}));
    if (!material.is_size_known) usda.line("bool size_known = false");
  } else {
    usda.line("string size_note = \"the size is not known; the rectangle is one metre wide\"");
  }
  if (!material.provenance.empty()) {
    usda.begin_list("dictionary provenance = {");
    for (const auto& [key, value] : material.provenance) {
      usda.line("string " + usda_string(key) + " = " + usda_string(value));
    }
    usda.end_list("}");
  }
  usda.end_list("}");
  usda.end_list("}");
  usda.line("defaultPrim = \"" + root + "\"");
  usda.line("doc = " + usda_string(material.name));
  usda.line("metersPerUnit = 1");
  usda.line("upAxis = \"Y\"");
  usda.end_list(")");
}

void write_mesh(UsdaWriter& usda, const ShownPlane& plane, const std::string& material_path) {
  const double x = plane.size_m[0] / 2, y = plane.size_m[1] / 2;
  const double u = plane.tiles[0], v = plane.tiles[1];
  const auto corners = [](double x0, double y0, double x1, double y1, bool has_z) {
    std::string text = "[";
    for (const auto& [cx, cy] : {std::pair(x0, y0), {x1, y0}, {x1, y1}, {x0, y1}}) {
      text += (text.size() > 1 ? ", " : "");
      text += has_z ? usda_tuple({cx, cy, 0}) : usda_tuple({cx, cy});
    }
    return text + "]";
  };
  usda.begin_list("def Mesh \"cloth\" (");
  usda.line("prepend apiSchemas = [\"MaterialBindingAPI\"]");
  usda.end_list(")");
  usda.begin_list("{");
  usda.line("uniform bool doubleSided = 1");
  usda.line("float3[] extent = [" + usda_tuple({-x, -y, 0}) + ", " + usda_tuple({x, y, 0}) + "]");
  usda.line("int[] faceVertexCounts = [4]");
  usda.line("int[] faceVertexIndices = [0, 1, 2, 3]");
  usda.line("rel material:binding = <" + material_path + ">");
  usda.begin_list("normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] (");
  usda.line("interpolation = \"vertex\"");
  usda.end_list(")");
  usda.line("point3f[] points = " + corners(-x, -y, x, y, true));
  usda.begin_list("texCoord2f[] primvars:st = " + corners(0, 0, u, v, false) + " (");
  usda.line("interpolation = \"vertex\"");
  usda.end_list(")");
  usda.line("uniform token subdivisionScheme = \"none\"");
  usda.end_block();
}

}  // namespace

Result<Document> usda_of(const TexturedMaterial& material, const UsdOptions& options) {
  if (auto checked = check_material(material); !checked) return checked.error();
  const auto plane = plane_of(material, options.tiles);
  if (!plane) return plane.error();
  if (!options.materialx_file.empty()) {
    if (auto path = check_portable_path(options.materialx_file); !path) return path.error();
  }
  const std::string root = identifier_of(material.name);
  const std::string material_path = "/" + root + "/Looks/" + root;
  Document document;
  UsdaWriter usda;
  write_layer_data(usda, material, root);
  usda.blank();
  usda.begin_list("def Xform \"" + root + "\" (");
  usda.line("kind = \"component\"");
  usda.end_list(")");
  usda.begin_list("{");
  write_mesh(usda, *plane, material_path);
  usda.blank();
  usda.begin_block("def Scope \"Looks\"");
  write_usda_material(usda, material, material_path, options.materialx_file, document);
  usda.end_block();
  usda.end_block();
  document.bytes = usda.text();
  if (!options.materialx_file.empty()) document.files.push_back(options.materialx_file);
  return document;
}

}  // namespace weft::exchange
