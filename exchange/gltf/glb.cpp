// SPDX-License-Identifier: Apache-2.0
#include "exchange/gltf/glb.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "exchange/gltf/gltf_material.h"
#include "exchange/image_kind.h"
#include "exchange/plane.h"

namespace weft::exchange {

namespace {

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
Json primitive_of(const Plane& plane, Buffer& buffer) {
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

Json provenance_of(const TexturedMaterial& material, const Plane& plane) {
  Json extras = {{"size_mm", nullptr}};
  if (material.size_mm) {
    extras["size_mm"] = *material.size_mm;
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
