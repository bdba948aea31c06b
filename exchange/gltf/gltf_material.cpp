// SPDX-License-Identifier: Apache-2.0
#include "exchange/gltf/gltf_material.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace weft::exchange {

namespace {

Error misplaced(const std::string& parameter, const Texture& texture, const std::string& place) {
  return {ErrorKind::kBadData, "glTF cannot read a texture from where it is", parameter,
          "it stands in the channels '" + texture.channels + "' of " + texture.file + ", glTF reads " + place,
          "pack it so"};
}

class MaterialWriter {
 public:
  MaterialWriter(const TexturedMaterial& material, const Json& transform)
      : material_(material), transform_(transform) {}

  Result<GltfMaterial> write(AlphaMode alpha_mode) {
    document_ = {{"name", material_.name}, {"doubleSided", true}};
    for (const auto part :
         {&MaterialWriter::put_base, &MaterialWriter::put_roughness_and_metal, &MaterialWriter::put_relief,
          &MaterialWriter::put_specular, &MaterialWriter::put_sheen, &MaterialWriter::put_anisotropy}) {
      if (auto done = (this->*part)(); !done) return done.error();
    }
    put_alpha_mode(alpha_mode);
    if (!extensions_.empty()) document_["extensions"] = extensions_;
    std::set<std::string> names;
    for (const auto& [name, value] : extensions_.items()) names.insert(name);
    if (!transform_.is_null() && !files_.empty()) names.insert("KHR_texture_transform");
    return GltfMaterial{document_, files_, {names.begin(), names.end()}, left_out_};
  }

 private:
  Json reference(const std::string& file) {
    const auto found = std::ranges::find(files_, file);
    Json json = {{"index", found - files_.begin()}};
    if (found == files_.end()) files_.push_back(file);
    if (!transform_.is_null()) json["extensions"] = {{"KHR_texture_transform", transform_}};
    return json;
  }

  Result<void> put_base() {
    Json& pbr = document_["pbrMetallicRoughness"];
    const Parameter& color = material_.base_color;
    const auto& opacity = material_.opacity;
    std::array<double, 4> factor = {color.constant[0], color.constant[1], color.constant[2],
                                    opacity ? opacity->constant[0] : 1};
    if (color.texture) {
      const Texture& texture = *color.texture;
      if (!texture.is_srgb || texture.offset != 0) {
        return misplaced("base_color", texture, "colours in sRGB without an offset");
      }
      pbr["baseColorTexture"] = reference(texture.file);
      std::fill_n(factor.begin(), 3, texture.scale);
    }
    if (opacity && opacity->texture) {
      const Texture& texture = *opacity->texture;
      if (!color.texture || texture.file != color.texture->file || texture.channels != "a" ||
          texture.offset != 0) {
        return misplaced("opacity", texture, "A of the file of the base colour");
      }
      factor[3] = texture.scale;
    }
    pbr["baseColorFactor"] = factor;
    return {};
  }

  Result<void> put_roughness_and_metal() {
    Json& pbr = document_["pbrMetallicRoughness"];
    const auto& roughness = material_.roughness;
    const auto& metallic = material_.metallic;
    double roughness_factor = roughness ? roughness->constant[0] : 1;
    double metallic_factor = metallic ? metallic->constant[0] : 0;
    const bool has_roughness_map = roughness && roughness->texture;
    const bool has_metal_map = metallic && metallic->texture;
    if (has_roughness_map) {
      const Texture& texture = *roughness->texture;
      if (texture.channels != "g" || texture.offset != 0) {
        return misplaced("roughness", texture, "G without an offset");
      }
      roughness_factor = texture.scale;
      pbr["metallicRoughnessTexture"] = reference(texture.file);
    }
    if (has_metal_map) {
      const Texture& texture = *metallic->texture;
      const bool shares = has_roughness_map && roughness->texture->file == texture.file;
      if (!shares || texture.channels != "b" || texture.offset != 0) {
        return misplaced("metallic", texture, "B of the file that has the roughness in G");
      }
      metallic_factor = texture.scale;
    }
    pbr["metallicFactor"] = metallic_factor;
    pbr["roughnessFactor"] = roughness_factor;
    return {};
  }

  Result<void> put_relief() {
    const auto& normal = material_.normal;
    if (normal && normal->texture) {
      document_["normalTexture"] = reference(normal->texture->file);
    }
    const auto& occlusion = material_.occlusion;
    if (occlusion && occlusion->texture) {
      const Texture& texture = *occlusion->texture;
      const bool is_faded = std::abs(texture.scale + texture.offset - 1) < 1e-9;
      if (texture.channels != "r" || !is_faded) return misplaced("occlusion", texture, "R, 1 being open");
      document_["occlusionTexture"] = reference(texture.file);
      document_["occlusionTexture"]["strength"] = texture.scale;
    } else if (occlusion && occlusion->constant[0] != 1) {
      left_out_.push_back("occlusion: glTF takes no constant");
    }
    if (material_.height_mm)
      left_out_.push_back("height_mm: glTF has no heights, the normals show the relief");
    return {};
  }

  Result<void> put_specular() {
    const auto& f0 = material_.f0;
    if (!f0) return {};
    if (!f0->texture) {
      extensions_["KHR_materials_ior"] = {{"ior", ior_of_f0(f0->constant[0])}};
      return {};
    }
    const Texture& texture = *f0->texture;
    if (texture.channels != "a" || texture.offset != 0) {
      return misplaced("f0", texture, "A without an offset");
    }
    // The texel weighs all of the lobe, at grazing angles too.
    extensions_["KHR_materials_ior"] = {{"ior", ior_of_f0(texture.scale)}};
    extensions_["KHR_materials_specular"] = {{"specularFactor", 1.0},
                                             {"specularTexture", reference(texture.file)}};
    return {};
  }

  Result<void> put_sheen() {
    const auto& color = material_.sheen_color;
    if (!color) return {};
    Json sheen = {{"sheenColorFactor", color->constant}};
    if (color->texture) {
      const Texture& texture = *color->texture;
      if (!texture.is_srgb || texture.offset != 0) {
        return misplaced("sheen_color", texture, "colours in sRGB without an offset");
      }
      sheen["sheenColorFactor"] = {texture.scale, texture.scale, texture.scale};
      sheen["sheenColorTexture"] = reference(texture.file);
    }
    const auto& roughness = material_.sheen_roughness;
    sheen["sheenRoughnessFactor"] = roughness ? roughness->constant[0] : 1.0;
    if (roughness && roughness->texture) {
      const Texture& texture = *roughness->texture;
      if (texture.channels != "a" || texture.offset != 0) {
        return misplaced("sheen_roughness", texture, "A without an offset");
      }
      sheen["sheenRoughnessFactor"] = texture.scale;
      sheen["sheenRoughnessTexture"] = reference(texture.file);
    }
    extensions_["KHR_materials_sheen"] = sheen;
    return {};
  }

  Result<void> put_anisotropy() {
    const auto& strength = material_.anisotropy;
    const auto& direction = material_.anisotropy_direction;
    if (!strength || (!strength->texture && strength->constant[0] == 0)) return {};
    Json anisotropy = {{"anisotropyStrength", strength->constant[0]}, {"anisotropyRotation", 0.0}};
    const bool has_direction_map = direction && direction->texture;
    if (strength->texture || has_direction_map) {
      const Texture& texture = strength->texture ? *strength->texture : *direction->texture;
      const bool is_one_file =
          strength->texture && has_direction_map && direction->texture->file == texture.file;
      if (!is_one_file || texture.channels != "b" || texture.offset != 0) {
        return misplaced("anisotropy", texture, "the direction in R and G and the strength in B of one file");
      }
      anisotropy["anisotropyStrength"] = texture.scale;
      anisotropy["anisotropyTexture"] = reference(texture.file);
    } else if (direction) {
      anisotropy["anisotropyRotation"] = std::atan2(direction->constant[1], direction->constant[0]);
    }
    extensions_["KHR_materials_anisotropy"] = anisotropy;
    return {};
  }

  void put_alpha_mode(AlphaMode alpha_mode) {
    const auto& opacity = material_.opacity;
    if (!opacity || (!opacity->texture && opacity->constant[0] >= 1)) return;
    document_["alphaMode"] = alpha_mode == AlphaMode::kMask ? "MASK" : "BLEND";
    if (alpha_mode == AlphaMode::kMask) document_["alphaCutoff"] = 0.5;
  }

  const TexturedMaterial& material_;
  const Json& transform_;
  Json document_, extensions_ = Json::object();
  std::vector<std::string> files_, left_out_;
};

}  // namespace

Result<GltfMaterial> gltf_material_of(const TexturedMaterial& material, AlphaMode alpha_mode,
                                      const Json& transform) {
  return MaterialWriter(material, transform).write(alpha_mode);
}

}  // namespace weft::exchange
