// SPDX-License-Identifier: Apache-2.0
#include "exchange/gltf/glb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "exchange/image_kind.h"
#include "exchange/plane.h"

namespace weft::exchange {

namespace {

// What `materials[0]` is and what it needs.
struct GltfMaterial {
  Json material;
  std::vector<std::string> files;       ///< `textures` by their index
  std::vector<std::string> extensions;  ///< sorted
  std::vector<std::string> left_out;
};

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
    const TexturedParameter& color = material_.base_color;
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

// `transform`: the KHR_texture_transform of every texture, or null.
Result<GltfMaterial> gltf_material_of(const TexturedMaterial& material, AlphaMode alpha_mode,
                                      const Json& transform) {
  return MaterialWriter(material, transform).write(alpha_mode);
}

constexpr int kFloat = 5126, kUnsignedShort = 5123, kVertices = 34962, kIndices = 34963;
constexpr int kRepeat = 10497, kClampToEdge = 33071, kLinear = 9729, kLinearMipmapLinear = 9987;

void put_word(std::string& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((value >> shift) & 0xff);
}

/// One element as a list: compilers read a pair of braces around one element differently.
Json list_of(Json element) {
  Json list = Json::array();
  list.push_back(std::move(element));
  return list;
}

/// The asset's binary part, and the lists that say what lies where in it.
struct Buffer {
  std::string bytes;
  Json views = Json::array(), accessors = Json::array();

  void pad() { bytes.resize((bytes.size() + 3) / 4 * 4, '\0'); }

  std::size_t add_view(std::string_view part, std::optional<int> target = {}) {
    pad();
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", part.size()}};
    if (target) view["target"] = *target;
    views.push_back(std::move(view));
    bytes += part;
    return views.size() - 1;
  }

  /// An accessor of four vectors of floats.
  std::size_t add_vectors(const std::vector<float>& numbers, const char* type) {
    std::string part;
    for (const float number : numbers) put_word(part, std::bit_cast<std::uint32_t>(number));
    accessors.push_back(
        {{"bufferView", add_view(part, kVertices)}, {"componentType", kFloat}, {"count", 4}, {"type", type}});
    return accessors.size() - 1;
  }
};

/// The rectangle's primitive: corners from the lower left, counterclockwise.
Json primitive_of(const ShownPlane& plane, Buffer& buffer) {
  const auto x = static_cast<float>(plane.size_m[0] / 2), y = static_cast<float>(plane.size_m[1] / 2);
  const auto position = buffer.add_vectors({-x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0}, "VEC3");
  buffer.accessors[position]["min"] = {-x, -y, 0};
  buffer.accessors[position]["max"] = {x, y, 0};
  const auto normal = buffer.add_vectors({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const auto tangent = buffer.add_vectors({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  const auto uv = buffer.add_vectors({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
  const auto indices = buffer.add_view(std::string_view("\0\0\1\0\2\0\0\0\2\0\3\0", 12), kIndices);
  buffer.accessors.push_back(
      {{"bufferView", indices}, {"componentType", kUnsignedShort}, {"count", 6}, {"type", "SCALAR"}});
  return {
      {"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}, {"TEXCOORD_0", uv}}},
      {"indices", buffer.accessors.size() - 1},
      {"material", 0}};
}

Json provenance_of(const TexturedMaterial& material, const ShownPlane& plane) {
  Json extras = {{"size_mm", nullptr}};
  if (material.size_mm) {
    extras["size_mm"] = *material.size_mm;
    if (!material.is_size_known) extras["size_known"] = false;
  } else {
    extras["size_note"] = "the size is not known; the rectangle is one metre wide";
  }
  extras["tiles"] = plane.tiles;
  Json provenance = Json::object();
  for (const auto& [key, value] : material.provenance) provenance[key] = value;
  extras["provenance"] = provenance;
  return {{"weft", extras}};
}

Result<void> add_image(const std::string& file, const TexturedMaterial& material, const FileBytes& files,
                       Buffer& buffer, Json& images) {
  const auto bytes = bytes_of(file, material, files, {ImageKind::kPng, ImageKind::kJpeg});
  if (!bytes) return bytes.error();
  if (buffer.bytes.size() + bytes->size() > std::numeric_limits<std::uint32_t>::max() - (64u << 20)) {
    return Error{ErrorKind::kBadData, "the .glb cannot be written", file,
                 "with it the file would not fit into 4 GiB", "export with fewer pixels"};
  }
  const char* type = kind_of_image(*bytes) == ImageKind::kPng ? "image/png" : "image/jpeg";
  images.push_back({{"name", file}, {"mimeType", type}, {"bufferView", buffer.add_view(*bytes)}});
  return {};
}

std::string container_of(const Json& asset, Buffer& buffer) {
  std::string text = asset.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  out.reserve(28 + text.size() + buffer.bytes.size());
  put_word(out, 2);
  put_word(out, static_cast<std::uint32_t>(28 + text.size() + buffer.bytes.size()));
  put_word(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON";
  out += text;
  put_word(out, static_cast<std::uint32_t>(buffer.bytes.size()));
  out += std::string_view("BIN\0", 4);
  out += buffer.bytes;
  return out;
}

}  // namespace

Result<Document> glb_of(const TexturedMaterial& material, const FileBytes& images,
                        const GlbOptions& options) {
  if (auto checked = check_material(material); !checked) return checked.error();
  const auto plane = plane_of(material, options.tiles);
  if (!plane) return plane.error();
  const bool is_one_tile = options.tiles == std::array<int, 2>{1, 1};
  const Json transform = is_one_tile ? Json() : Json{{"scale", options.tiles}};
  auto written = gltf_material_of(material, options.alpha_mode, transform);
  if (!written) return written.error();

  Buffer buffer;
  Json asset = {
      {"asset", {{"version", "2.0"}, {"generator", "weft"}, {"extras", provenance_of(material, *plane)}}}};
  if (!written->extensions.empty()) asset["extensionsUsed"] = written->extensions;
  asset["scene"] = 0;
  asset["scenes"] = list_of({{"nodes", Json::array({0})}});
  asset["nodes"] = list_of({{"name", material.name}, {"mesh", 0}});
  asset["meshes"] = list_of({{"name", material.name}, {"primitives", list_of(primitive_of(*plane, buffer))}});
  asset["materials"] = list_of(written->material);
  if (!written->files.empty()) {
    Json list = Json::array(), textures = Json::array();
    for (const std::string& file : written->files) {
      textures.push_back({{"source", list.size()}, {"sampler", 0}});
      if (auto added = add_image(file, material, images, buffer, list); !added) return added.error();
    }
    const int wrap = material.repeats ? kRepeat : kClampToEdge;
    asset["textures"] = textures;
    asset["images"] = list;
    asset["samplers"] = list_of(
        {{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}, {"wrapS", wrap}, {"wrapT", wrap}});
  }
  buffer.pad();
  asset["accessors"] = buffer.accessors;
  asset["bufferViews"] = buffer.views;
  asset["buffers"] = list_of({{"byteLength", buffer.bytes.size()}});
  return Document{container_of(asset, buffer), written->files, written->left_out};
}

}  // namespace weft::exchange
