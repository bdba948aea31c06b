// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/textured.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "exchange/export/map_planes.h"

namespace weft::exchange {
namespace {

// A texture, how it is stored, and where in it the channels begin.
struct FoundChannels {
  const ExportedTexture& texture;
  const Stored& stored;
  std::size_t first = 0;
};

std::optional<FoundChannels> find_channels(const ClothTextures& cloth,
                                           const std::vector<std::string>& channels) {
  for (std::size_t i = 0; i < cloth.textures.size(); ++i) {
    const PresetFile& file = cloth.preset.textures[i].file;
    const std::vector<std::string>& all = file.channels;
    const auto found = std::search(all.begin(), all.end(), channels.begin(), channels.end());
    if (found == all.end()) continue;
    return FoundChannels{cloth.textures[i], file.stored, static_cast<std::size_t>(found - all.begin())};
  }
  return std::nullopt;
}

// The source of the map that the first channel comes from.
std::string source_in(const MapFolder& maps, const Channel& channel) {
  for (const MapPlane plane : channel.planes) {
    if (const material::MapFacts* map = maps.map(kind_of(plane).map)) return name_of(map->source);
  }
  return "assumed";
}

Texture texture_of(const FoundChannels& found, std::size_t count, const Channel& channel) {
  constexpr std::string_view kLetters = "rgba";
  Texture texture = {.file = found.texture.file, .size = found.texture.size, .bits = found.stored.bits};
  texture.channels = kLetters.substr(found.first, count);
  texture.is_srgb = found.stored.color == ColorSpace::kSrgb && channel.kind == ChannelKind::kColor;
  // Directions are n / 2 + 1/2 by the noun itself.
  if (channel.kind == ChannelKind::kNormal || found.stored.is_float()) return texture;
  const ExportedChannel& written = found.texture.channels[found.first];
  texture.scale = *written.at_1 - *written.at_0;
  texture.offset = *written.at_0;
  return texture;
}

std::optional<TexturedParameter> parameter_of(const ClothTextures& cloth,
                                              const std::vector<std::string>& channels) {
  const std::optional<FoundChannels> found = find_channels(cloth, channels);
  if (!found) return std::nullopt;
  const Channel& first = *channel_named(channels.front());
  TexturedParameter parameter = {.texture = texture_of(*found, channels.size(), first),
                                 .source = source_in(cloth.maps, first)};
  const ChannelFacts facts = channel_facts(cloth.maps, {});
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const ChannelRange range = range_of(*channel_named(channels[i]), facts);
    const double mean = found->texture.channels[found->first + i].mean;
    parameter.constant[i] = std::clamp(mean, range.least, range.most);
  }
  return parameter;
}

bool is_one_number(const ExportedChannel& channel) {
  return channel.least == channel.most;
}

bool is_same_everywhere(const ExportedTexture& file, const Texture& texture) {
  const auto first = file.channels.begin() +
                     static_cast<std::ptrdiff_t>(std::string_view("rgba").find(texture.channels.front()));
  return std::all_of(first, first + static_cast<std::ptrdiff_t>(texture.channels.size()), is_one_number);
}

bool is_flat(const TexturedParameter& normal) {
  return normal.constant[0] == 0 && normal.constant[1] == 0;
}

// What is one number leaves as a number, unless a format multiplies it with its neighbour in the file (glTF),
// or takes none.
class Constants {
 public:
  Constants(TexturedMaterial& material, const std::vector<ExportedTexture>& files)
      : material_(material), files_(files) {}

  void take(bool takes_no_occlusion) {
    together({&base_color_, &material_.opacity});
    material_.base_color = *base_color_;
    together({&material_.roughness, &material_.metallic});
    together({&material_.anisotropy, &material_.anisotropy_direction});
    for (auto* alone :
         {&material_.height_mm, &material_.f0, &material_.sheen_color, &material_.sheen_roughness})
      together({alone});
    if (material_.normal && is_flat(*material_.normal)) together({&material_.normal});
    const auto& occlusion = material_.occlusion;
    if (occlusion && (occlusion->constant[0] == 1 || !takes_no_occlusion)) together({&material_.occlusion});
  }

 private:
  bool is_same(const TexturedParameter& parameter) const {
    const auto file = std::ranges::find(files_, parameter.texture->file, &ExportedTexture::file);
    return is_same_everywhere(*file, *parameter.texture);
  }

  // A group that stands in one file leaves as numbers altogether, or not at all.
  void together(std::initializer_list<std::optional<TexturedParameter>*> group) {
    std::set<std::string> varying;
    for (const std::optional<TexturedParameter>* each : group) {
      if (*each && (*each)->texture && !is_same(**each)) varying.insert((*each)->texture->file);
    }
    for (std::optional<TexturedParameter>* each : group) {
      if (*each && (*each)->texture && !varying.contains((*each)->texture->file)) (*each)->texture.reset();
    }
  }

  TexturedMaterial& material_;
  const std::vector<ExportedTexture>& files_;
  std::optional<TexturedParameter> base_color_ = material_.base_color;
};

// Reflectance itself, or over 0.08, which uses more of the steps of a file.
std::optional<TexturedParameter> reflectance_of(const ClothTextures& cloth) {
  if (std::optional<TexturedParameter> plain = parameter_of(cloth, {"f0"})) return plain;
  std::optional<TexturedParameter> scaled = parameter_of(cloth, {"specular"});
  if (!scaled) return scaled;
  constexpr double kF0OfSpecular = 0.08;
  scaled->texture->scale *= kF0OfSpecular;
  scaled->texture->offset *= kF0OfSpecular;
  scaled->constant[0] *= kF0OfSpecular;
  return scaled;
}

// Ids as texts, and the source of each map.
std::vector<std::pair<std::string, std::string>> provenance_words(const MapFolder& maps) {
  std::vector<std::pair<std::string, std::string>> words = {{maps.kind, maps.id}};
  for (const char* key : {"solve", "rectified"}) {
    if (maps.kind != key && maps.document.contains(key) && maps.document[key].is_string())
      words.emplace_back(key, maps.document[key].get<std::string>());
  }
  if (maps.session) {
    words.emplace_back("session", maps.session->folder.filename().string());
    if (!maps.session->calibration_id.empty())
      words.emplace_back("calibration", maps.session->calibration_id);
  }
  words.emplace_back("albedo_scale", maps.albedo_scale);
  for (const material::MapFacts& map : maps.maps)
    words.emplace_back("source." + map.name, name_of(map.source));
  return words;
}

}  // namespace

bool is_said_as_number(const ExportedTexture& texture, const std::vector<std::string>& named) {
  static const std::set<std::string> kParameters = {
      "albedo.r",        "albedo.g",     "albedo.b",  "normal.x", "normal.y",
      "normal.z",        "height",       "occlusion", "opacity",  "roughness",
      "roughness.least", "f0",           "specular",  "metallic", "anisotropy",
      "anisotropy.x",    "anisotropy.y", "sheen.r",   "sheen.g",  "sheen.b",
      "sheen_roughness", "zero",         "half",      "one"};
  const bool is_plain = std::ranges::all_of(texture.channels, [](const ExportedChannel& channel) {
    return is_one_number(channel) && kParameters.contains(channel.name);
  });
  return is_plain && std::ranges::find(named, texture.file) == named.end();
}

TexturedMaterial textured_material(const ClothTextures& cloth) {
  const auto& [maps, preset, textures] = cloth;
  const auto of = [&](const std::vector<std::string>& channels) { return parameter_of(cloth, channels); };
  TexturedMaterial material;
  material.name = preset.title;
  if (preset.pitch_mm[0] > 0)
    material.size_mm = {preset.pitch_mm[0] * preset.size.width, preset.pitch_mm[1] * preset.size.height};
  material.is_size_known = maps.is_size_known;
  material.repeats = maps.is_tile;
  material.base_color =
      of({"albedo.r", "albedo.g", "albedo.b"}).value_or(TexturedParameter{.constant = {0.5, 0.5, 0.5}});
  material.normal = of({"normal.x", "normal.y", "normal.z"});
  material.height_mm = of({"height"});
  material.roughness = of({"roughness.least"});
  if (!material.roughness) material.roughness = of({"roughness"});
  material.occlusion = of({"occlusion"});
  if (const material::MapFacts* opacity = maps.map("opacity")) {
    if (!(opacity->constant && *opacity->constant == 1)) material.opacity = of({"opacity"});
  }
  material.f0 = reflectance_of(cloth);
  material.metallic = of({"metallic"});
  material.anisotropy = of({"anisotropy"});
  material.anisotropy_direction = of({"anisotropy.x", "anisotropy.y"});
  material.sheen_color = of({"sheen.r", "sheen.g", "sheen.b"});
  material.sheen_roughness = of({"sheen_roughness"});
  material.provenance = provenance_words(maps);
  const bool has_glb = std::ranges::any_of(
      preset.documents, [](const PresetDocument& document) { return document.kind == DocumentKind::kGlb; });
  Constants(material, textures).take(has_glb);
  return material;
}

}  // namespace weft::exchange
