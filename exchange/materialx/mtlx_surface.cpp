// SPDX-License-Identifier: Apache-2.0
#include "exchange/materialx/mtlx_surface.h"

#include <algorithm>
#include <cmath>

namespace weft::exchange {

namespace {

MtlxValue mtlx_color(const std::array<double, 3>& color) {
  return {"color3", "", {color[0], color[1], color[2]}};
}

/// Roughness and anisotropy of a model, of the two alphas of a lobe.
struct Lobe {
  double roughness = 0, anisotropy = 0;
};

/// OpenPBR: along = r^2 sqrt(2 / (1 + (1 - a)^2)); standard_surface: along = r^2 / sqrt(1 - a); across is
/// (1 - a) along in both.
Lobe lobe_of(SurfaceModel model, const Alphas& alphas) {
  if (alphas.along <= 0) return {};
  const bool is_open_pbr = model == SurfaceModel::kOpenPbr;
  const double squared = is_open_pbr ? std::hypot(alphas.along, alphas.across) / std::sqrt(2)
                                     : std::sqrt(alphas.along * alphas.across);
  return {std::sqrt(squared), 1 - alphas.across / alphas.along};
}

/// The same by nodes.
std::pair<MtlxValue, MtlxValue> lobe_nodes(MtlxGraph& graph, SurfaceModel model, const MtlxValue& roughness,
                                           const MtlxValue& anisotropy) {
  const auto times = [&](const std::string& name, const MtlxValue& a, const MtlxValue& b) {
    return graph.node(name, "multiply", "float", {{"in1", a}, {"in2", b}});
  };
  const MtlxValue across = times("alpha_across", roughness, roughness);
  const MtlxValue share = times("anisotropy_squared", anisotropy, anisotropy);
  const MtlxValue mixed =
      graph.node("alpha_along", "mix", "float", {{"fg", mtlx_float(1)}, {"bg", across}, {"mix", share}});
  const MtlxValue along =
      graph.node("alpha_along_positive", "max", "float", {{"in1", mixed}, {"in2", mtlx_float(1e-6)}});
  const MtlxValue ratio = graph.node("alpha_ratio", "divide", "float", {{"in1", across}, {"in2", along}});
  const MtlxValue strength =
      graph.node("lobe_anisotropy", "subtract", "float", {{"in1", mtlx_float(1)}, {"in2", ratio}});
  const bool is_open_pbr = model == SurfaceModel::kOpenPbr;
  const std::string name = is_open_pbr ? "open_pbr" : "standard";
  MtlxValue fourth;
  if (is_open_pbr) {
    const MtlxValue sum = graph.node("alpha_squares", "add", "float",
                                     {{"in1", times("alpha_along_squared", along, along)},
                                      {"in2", times("alpha_across_squared", across, across)}});
    fourth = times("alpha_mean_square", sum, mtlx_float(0.5));
  } else {
    fourth = times("alpha_product", along, across);
  }
  const MtlxValue square = graph.node("alpha_" + name, "sqrt", "float", {{"in", fourth}});
  return {graph.node("roughness_" + name, "sqrt", "float", {{"in", square}}), strength};
}

}  // namespace

void MtlxSurface::put(const char* open_pbr, const char* standard, const char* gltf, const MtlxValue& value) {
  const char* name = model_ == SurfaceModel::kOpenPbr           ? open_pbr
                     : model_ == SurfaceModel::kStandardSurface ? standard
                                                                : gltf;
  if (name == nullptr) return;
  if (!value.is_constant()) graph_.output(value);
  inputs_.push_back({name, value});
}

MtlxValue MtlxSurface::value_of(const char* name, const TexturedParameter& parameter) {
  return parameter.texture ? graph_.scalar(name, *parameter.texture) : mtlx_float(parameter.constant[0]);
}

void MtlxSurface::prepare() {
  put_base();
  put_lobe();
  put_reflectance();
  put_sheen();
  put_opacity();
  put_frame();
  if (material_.occlusion && model_ != SurfaceModel::kGltfPbr) {
    left_out_.push_back(std::string("occlusion: ") + name_of(model_) + " has none");
  }
}

void MtlxSurface::put_base() {
  const TexturedParameter& color = material_.base_color;
  MtlxValue value = mtlx_color(color.constant);
  if (color.texture) {
    value = graph_.color_texels("base_color", *color.texture);
    value = graph_.scaled("base_color", value, color.texture->scale, color.texture->offset);
  }
  put(nullptr, "base", nullptr, mtlx_float(1));
  put("base_color", "base_color", "base_color", value);
  const MtlxValue metallic = material_.metallic ? value_of("metallic", *material_.metallic) : mtlx_float(0);
  put("base_metalness", "metalness", "metallic", metallic);
}

void MtlxSurface::put_lobe() {
  if (!material_.roughness) return;
  MtlxValue roughness = value_of("roughness", *material_.roughness);
  const auto& strength = material_.anisotropy;
  if (!strength || (!strength->texture && strength->constant[0] == 0)) {
    put("specular_roughness", "specular_roughness", "roughness", roughness);
    return;
  }
  MtlxValue anisotropy = value_of("anisotropy", *strength);
  if (model_ != SurfaceModel::kGltfPbr) {
    if (roughness.is_constant() && anisotropy.is_constant()) {
      const Lobe lobe = lobe_of(model_, alphas_of(roughness.constant[0], anisotropy.constant[0]));
      roughness = mtlx_float(lobe.roughness);
      anisotropy = mtlx_float(lobe.anisotropy);
    } else {
      std::tie(roughness, anisotropy) = lobe_nodes(graph_, model_, roughness, anisotropy);
    }
  }
  put("specular_roughness", "specular_roughness", "roughness", roughness);
  put("specular_roughness_anisotropy", "specular_anisotropy", "anisotropy_strength", anisotropy);
  put("geometry_tangent", "tangent", "tangent", tangent());
}

/// World directions, so that no rotation's sense is left to a renderer.
MtlxValue MtlxSurface::tangent() {
  const MtlxValue x_axis = graph_.word_node("tangent_world", "tangent", "vector3", "space", "world");
  const auto& direction = material_.anisotropy_direction;
  if (!direction) return x_axis;
  MtlxValue x = mtlx_float(direction->constant[0]), y = mtlx_float(direction->constant[1]);
  if (direction->texture) {
    const MtlxValue texels = graph_.vector_texels("direction", *direction->texture);
    const MtlxValue vector = graph_.scaled("direction", texels, 2, -1);
    const auto component = [&](const char* name, int index) {
      return graph_.node(name, "extract", "float",
                         {{"in", vector}, {"index", {"integer", "", {double(index)}}}});
    };
    x = component("direction_x", 0);
    y = component("direction_y", 1);
  } else if (y.constant[0] == 0) {
    return x_axis;
  }
  const MtlxValue y_axis = graph_.word_node("bitangent_world", "bitangent", "vector3", "space", "world");
  const MtlxValue along_x =
      graph_.node("direction_along_x", "multiply", "vector3", {{"in1", x_axis}, {"in2", x}});
  const MtlxValue along_y =
      graph_.node("direction_along_y", "multiply", "vector3", {{"in1", y_axis}, {"in2", y}});
  const MtlxValue sum =
      graph_.node("direction_world", "add", "vector3", {{"in1", along_x}, {"in2", along_y}});
  return graph_.node("direction_unit", "normalize", "vector3", {{"in", sum}});
}

/// OpenPBR's weight scales F0, the others' all of the lobe; the index takes the most that texels can say.
void MtlxSurface::put_reflectance() {
  const auto& f0 = material_.f0;
  if (!f0) return;
  double most = f0->constant[0];
  if (f0->texture) {
    const Texture& texture = *f0->texture;
    most = std::max(texture.offset, texture.scale + texture.offset);
    if (most > 0) {
      const MtlxValue value = graph_.scalar("f0", texture);
      put("specular_weight", "specular", "specular", graph_.scaled("f0_weight", value, 1 / most, 0));
    }
  }
  put("specular_ior", "specular_IOR", "ior", mtlx_float(ior_of_f0(most)));
}

void MtlxSurface::put_sheen() {
  const auto& sheen = material_.sheen_color;
  if (!sheen) return;
  const auto& constant = sheen->constant;
  double weight = *std::ranges::max_element(constant);
  MtlxValue color = mtlx_color(constant);
  if (!sheen->texture) {
    if (weight <= 0) return;
    if (model_ != SurfaceModel::kGltfPbr) color = graph_.scaled("sheen_color", color, 1 / weight, 0);
  } else {
    const Texture& texture = *sheen->texture;
    color = graph_.color_texels("sheen_color", texture);
    weight = texture.scale;
    if (model_ == SurfaceModel::kGltfPbr || texture.offset != 0 || weight < 0) {
      color = graph_.scaled("sheen_color", color, texture.scale, texture.offset);
      weight = 1;
    }
  }
  put("fuzz_weight", "sheen", nullptr, mtlx_float(weight));
  put("fuzz_color", "sheen_color", "sheen_color", color);
  if (!material_.sheen_roughness) return;
  MtlxValue roughness = value_of("sheen_roughness", *material_.sheen_roughness);
  if (model_ == SurfaceModel::kStandardSurface) {
    roughness = roughness.is_constant() ? mtlx_float(roughness.constant[0] * roughness.constant[0])
                                        : graph_.node("sheen_roughness_squared", "multiply", "float",
                                                      {{"in1", roughness}, {"in2", roughness}});
  }
  put("fuzz_roughness", "sheen_roughness", "sheen_roughness", roughness);
}

void MtlxSurface::put_opacity() {
  if (material_.occlusion) {
    put(nullptr, nullptr, "occlusion", value_of("occlusion", *material_.occlusion));
  }
  put("geometry_thin_walled", "thin_walled", nullptr, {"boolean", "", {1}});
  if (!material_.opacity) return;
  const MtlxValue opacity = value_of("opacity", *material_.opacity);
  if (model_ == SurfaceModel::kGltfPbr) put(nullptr, nullptr, "alpha_mode", {"integer", "", {1}});
  if (model_ != SurfaceModel::kStandardSurface) {
    put("geometry_opacity", nullptr, "alpha", opacity);
  } else if (opacity.is_constant()) {
    const double value = opacity.constant[0];
    put(nullptr, "opacity", nullptr, mtlx_color({value, value, value}));
  } else {
    put(nullptr, "opacity", nullptr, graph_.node("opacity_color", "convert", "color3", {{"in", opacity}}));
  }
}

void MtlxSurface::put_frame() {
  const auto& normal = material_.normal;
  if (!normal || !normal->texture) return;
  const MtlxValue texels = graph_.vector_texels("normal", *normal->texture);
  put("geometry_normal", "normal", "normal",
      graph_.node("normal_world", "normalmap", "vector3", {{"in", texels}}));
}

void MtlxSurface::write(XmlWriter& xml, const std::string& name) const {
  xml.open(name_of(model_), {{"name", name}, {"type", "surfaceshader"}});
  for (const Input& input : inputs_) {
    const MtlxValue& value = input.value;
    if (!value.is_constant()) {
      xml.leaf("input", {{"name", input.name},
                         {"type", value.type},
                         {"nodegraph", graph_.name()},
                         {"output", "out_" + value.node}});
    } else {
      const std::string text = value.type == "boolean" ? "true" : numbers_text(value.constant);
      xml.leaf("input", {{"name", input.name}, {"type", value.type}, {"value", text}});
    }
  }
  xml.close();
}

}  // namespace weft::exchange
