// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/export/textured.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace weft::app {
namespace {

using exchange::Parameter;
using exchange::Texture;
using exchange::TexturedMaterial;

// A file, and where in it the channels begin.
struct FoundChannels {
  const EncodedFile* file = nullptr;
  std::size_t first = 0;
};

std::optional<FoundChannels> find_channels(const std::vector<EncodedFile>& files,
                                           const std::vector<std::string>& channels) {
  for (const EncodedFile& file : files) {
    const std::vector<std::string>& all = file.file.channels;
    const auto found = std::search(all.begin(), all.end(), channels.begin(), channels.end());
    if (found != all.end()) return FoundChannels{&file, static_cast<std::size_t>(found - all.begin())};
  }
  return std::nullopt;
}

// Of the map that the first channel comes from.
std::string source_in(const MapFolder& maps, const exchange::Channel& channel) {
  for (const exchange::Plane plane : channel.planes) {
    if (const FolderMap* map = maps.map(exchange::kind_of(plane).map)) return map->source;
  }
  return "assumed";
}

Texture texture_of(const FoundChannels& found, std::size_t count, const exchange::Channel& channel) {
  const EncodedFile& file = *found.file;
  constexpr std::string_view kLetters = "rgba";
  Texture texture = {.file = file.name, .size = file.size, .bits = file.file.stored.bits};
  texture.channels = kLetters.substr(found.first, count);
  texture.is_srgb =
      file.file.stored.color == ColorSpace::kSrgb && channel.kind == exchange::ChannelKind::kColor;
  // Directions are n / 2 + 1/2 by the noun itself.
  if (channel.kind == exchange::ChannelKind::kNormal || file.file.stored.is_float()) return texture;
  const exchange::ChannelRange range = exchange::range_of(channel, file.facts);
  texture.scale = range.most - range.least;
  texture.offset = range.least;
  return texture;
}

std::optional<Parameter> parameter_of(const MapFolder& maps, const std::vector<EncodedFile>& files,
                                      const std::vector<std::string>& channels) {
  const std::optional<FoundChannels> found = find_channels(files, channels);
  if (!found) return std::nullopt;
  const exchange::Channel& first = *exchange::channel_named(channels.front());
  Parameter parameter = {.texture = texture_of(*found, channels.size(), first),
                         .source = source_in(maps, first)};
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const exchange::ChannelRange range =
        exchange::range_of(*exchange::channel_named(channels[i]), found->file->facts);
    const double mean = found->file->loss.channels[found->first + i].mean;
    parameter.constant[i] = std::clamp(mean, range.least, range.most);
  }
  return parameter;
}

// Reflectance itself, or over 0.08, which uses more of the steps of a file.
std::optional<Parameter> reflectance_of(const MapFolder& maps, const std::vector<EncodedFile>& files) {
  if (std::optional<Parameter> plain = parameter_of(maps, files, {"f0"})) return plain;
  std::optional<Parameter> scaled = parameter_of(maps, files, {"specular"});
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
  for (const FolderMap& map : maps.maps) words.emplace_back("source." + map.name, map.source);
  return words;
}

}  // namespace

TexturedMaterial textured_material(const PlannedExport& plan, const MapFolder& maps,
                                   const std::vector<EncodedFile>& files) {
  const auto of = [&](const std::vector<std::string>& channels) {
    return parameter_of(maps, files, channels);
  };
  TexturedMaterial material;
  material.name = plan.name;
  if (plan.pitch_mm[0] > 0)
    material.size_mm = {plan.pitch_mm[0] * plan.size.width, plan.pitch_mm[1] * plan.size.height};
  material.repeats = maps.is_tile;
  material.base_color =
      of({"albedo.r", "albedo.g", "albedo.b"}).value_or(Parameter{.constant = {0.5, 0.5, 0.5}});
  material.normal = of({"normal.x", "normal.y", "normal.z"});
  material.height_mm = of({"height"});
  material.roughness = of({"roughness.least"});
  if (!material.roughness) material.roughness = of({"roughness"});
  material.occlusion = of({"occlusion"});
  if (const FolderMap* opacity = maps.map("opacity")) {
    if (!(opacity->constant && *opacity->constant == 1)) material.opacity = of({"opacity"});
  }
  material.f0 = reflectance_of(maps, files);
  material.metallic = of({"metallic"});
  material.anisotropy = of({"anisotropy"});
  material.anisotropy_direction = of({"anisotropy.x", "anisotropy.y"});
  material.sheen_color = of({"sheen.r", "sheen.g", "sheen.b"});
  material.sheen_roughness = of({"sheen_roughness"});
  material.provenance = provenance_words(maps);
  return material;
}

}  // namespace weft::app
