// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/export/export_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace weft::app {
namespace {

using exchange::Channel;
using exchange::ChannelLoss;

bool has_any(const exchange::PresetFile& file, std::initializer_list<const char*> channels) {
  return std::ranges::any_of(channels, [&](const char* channel) {
    return std::ranges::find(file.channels, channel) != file.channels.end();
  });
}

// Of the map that a channel comes from; "assumed" where it comes from none.
std::string source_of(const MapFolder& folder, const Channel& channel) {
  for (const exchange::Plane plane : channel.planes) {
    const std::string name = exchange::kind_of(plane).map;
    const FolderMap* map = folder.map(name);
    if (map == nullptr && name == "specular") map = folder.map("f0");
    if (map != nullptr) return map->source;
  }
  return "assumed";
}

Json channel_json(const EncodedFile& file, const ChannelLoss& loss, const MapFolder& folder) {
  const Channel& channel = *exchange::channel_named(loss.channel);
  Json json = {{"name", loss.channel}};
  if (*channel.unit != '\0') json["unit"] = channel.unit;
  json["source"] = source_of(folder, channel);
  if (!file.file.stored.is_float()) {
    const exchange::ChannelRange range = exchange::range_of(channel, file.facts);
    json["at_0"] = range.least;
    json["at_1"] = range.most;
  }
  json["least"] = loss.least;
  json["most"] = loss.most;
  json["mean"] = loss.mean;
  json["lost"] = {{"mean", loss.mean_abs}, {"max", loss.most_abs}};
  json["cut_share"] = static_cast<double>(loss.cut) / static_cast<double>(file.size.pixels());
  return json;
}

Json file_json(const PlannedExport& plan, const EncodedFile& file, const MapFolder& folder) {
  const exchange::Stored& stored = file.file.stored;
  Json json = {{"file", file.name},
               {"sha256", file.sha256},
               {"bytes", file.bytes},
               {"width", file.size.width},
               {"height", file.size.height},
               {"levels", file.levels},
               {"encoding", words_of(stored)},
               {"color", exchange::kColorSpaceNames[static_cast<std::size_t>(stored.color)]}};
  if (has_any(file.file, {"normal.y", "detail.normal.y"}))
    json["direction"] = exchange::kNormalDirectionNames[static_cast<std::size_t>(file.file.direction)];
  if (has_any(file.file, {"roughness", "roughness.least"}))
    json["roughness"] = exchange::kRoughnessConventionNames[static_cast<std::size_t>(plan.preset.roughness)];
  json["channels"] = Json::array();
  for (const ChannelLoss& channel : file.loss.channels)
    json["channels"].push_back(channel_json(file, channel, folder));
  json["lost"] = json_of(file.loss);
  return json;
}

Json json_of(const WrittenDocument& document) {
  return {{"file", document.name},   {"kind", document.kind},   {"sha256", document.sha256},
          {"bytes", document.bytes}, {"files", document.files}, {"left_out", document.left_out}};
}

// What becomes of roughness some eight times as far, where engines make the mips; empty where they are right
// to 2 percent.
std::string distance_note(const std::vector<EncodedFile>& files) {
  constexpr double kNothing = 0.02;
  for (const EncodedFile& file : files) {
    const exchange::DistanceLoss* seen = nullptr;
    for (const exchange::DistanceLoss& each : file.loss.by_distance) {
      if (each.level <= kToldDistance) seen = &each;
    }
    if (seen == nullptr || seen->mean_abs <= kNothing * seen->mean) continue;
    return fmt::format(
        "Seen from {} times as far an engine's own mips of {} have {:.3g} in the mean where the cloth has "
        "{:.3g}: they lose the spread of normals. The presets dds, order1886, arnold and renderman hold mips "
        "that keep it.",
        1 << seen->level, file.name, seen->engine, seen->mean);
  }
  return {};
}

// One number where pixels are square, two where they are not, null where nobody knows.
Json pitch_json(const PixelPitch& pitch_mm) {
  if (pitch_mm[0] == 0) return nullptr;
  if (pitch_mm[0] == pitch_mm[1]) return pitch_mm[0];
  return {pitch_mm[0], pitch_mm[1]};
}

}  // namespace

Json json_of(const exchange::Loss& loss) {
  Json json = Json::object();
  if (loss.normal) {
    json["normal_deg"] = {
        {"mean", loss.normal->mean_deg}, {"p95", loss.normal->p95_deg}, {"max", loss.normal->max_deg}};
  }
  if (loss.albedo) {
    json["albedo"] = {{"mean", loss.albedo->mean_abs}};
    json["albedo"]["psnr_db"] = loss.albedo->psnr_db ? Json(*loss.albedo->psnr_db) : Json();
  }
  for (const exchange::DistanceLoss& each : loss.by_distance) {
    json["by_distance"].push_back({{"channel", each.channel},
                                   {"level", each.level},
                                   {"mean", each.mean},
                                   {"engine", each.engine},
                                   {"lost", each.mean_abs}});
  }
  return json;
}

Json export_document(const PlannedExport& plan, const MapFolder& folder, const Json& provenance,
                     const std::vector<EncodedFile>& files, const std::vector<WrittenDocument>& documents) {
  const bool is_known = plan.pitch_mm[0] > 0;
  Json json = {
      {"schema", std::string(kExportProduct.schema) + "/1"},
      {"id", plan.id},
      {"preset", plan.preset.name},
      {"name", plan.name},
      {"title", plan.title},
      {"normal", plan.preset.normal},
      {"roughness", exchange::kRoughnessConventionNames[static_cast<std::size_t>(plan.preset.roughness)]},
      {"width", plan.size.width},
      {"height", plan.size.height},
      {"mm_per_pixel", pitch_json(plan.pitch_mm)},
      {"size_mm",
       is_known ? Json{plan.pitch_mm[0] * plan.size.width, plan.pitch_mm[1] * plan.size.height} : Json()},
      {"is_tile", folder.is_tile},
      {"albedo_scale", folder.albedo_scale},
      {"notes", plan.notes},
      {"files", Json::array()},
      {"documents", Json::array()},
      {"from", provenance}};
  if (const std::string note = distance_note(files); !note.empty()) json["notes"].push_back(note);
  for (const EncodedFile& file : files) {
    json["files"].push_back(file_json(plan, file, folder));
    if (plan.preset.keeps_no_files()) json["files"].back()["inside"] = plan.documents.front().name;
  }
  for (const WrittenDocument& document : documents) json["documents"].push_back(json_of(document));
  return json;
}

}  // namespace weft::app
