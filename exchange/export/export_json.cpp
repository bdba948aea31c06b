// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/export_json.h"

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

ExportedChannel channel_facts(const EncodedFile& file, const ChannelLoss& loss, const MapFolder& folder) {
  const Channel& channel = *exchange::channel_named(loss.channel);
  ExportedChannel facts = {
      .name = loss.channel,
      .unit = channel.unit,
      .source = source_of(folder, channel),
      .least = loss.least,
      .most = loss.most,
      .mean = loss.mean,
      .lost = {loss.mean_abs, loss.most_abs},
      .cut_share = static_cast<double>(loss.cut) / static_cast<double>(file.size.pixels())};
  if (file.file.stored.is_float()) return facts;
  const exchange::ChannelRange range = exchange::range_of(channel, file.facts);
  facts.at_0 = range.least;
  facts.at_1 = range.most;
  return facts;
}

ExportedTexture file_facts(const PlannedExport& plan, const EncodedFile& file, const MapFolder& folder) {
  const exchange::Stored& stored = file.file.stored;
  ExportedTexture facts = {.file = file.name,
                           .sha256 = file.sha256,
                           .bytes = file.bytes,
                           .size = file.size,
                           .levels = file.levels,
                           .encoding = words_of(stored),
                           .color = stored.color,
                           .lost = file.loss};
  if (has_any(file.file, {"normal.y", "detail.normal.y"}))
    facts.direction = exchange::kNormalDirectionNames[static_cast<std::size_t>(file.file.direction)];
  if (has_any(file.file, {"roughness", "roughness.least"}))
    facts.roughness = exchange::kRoughnessConventionNames[static_cast<std::size_t>(plan.preset.roughness)];
  for (const ChannelLoss& channel : file.loss.channels)
    facts.channels.push_back(channel_facts(file, channel, folder));
  if (plan.preset.keeps_no_files()) facts.inside = plan.documents.front().name;
  return facts;
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

}  // namespace

ExportFacts export_facts(const PlannedExport& plan, const MapFolder& folder, const Json& provenance,
                         const std::vector<EncodedFile>& files,
                         const std::vector<WrittenDocument>& documents) {
  ExportFacts facts = {
      .id = plan.id,
      .preset = plan.preset.name,
      .name = plan.name,
      .title = plan.title,
      .normal = plan.preset.normal,
      .roughness = exchange::kRoughnessConventionNames[static_cast<std::size_t>(plan.preset.roughness)],
      .size = plan.size,
      .is_tile = folder.is_tile,
      .albedo_scale = folder.albedo_scale,
      .notes = plan.notes,
      .documents = documents,
      .from = provenance};
  if (const auto& pitch_mm = plan.pitch_mm; pitch_mm[0] > 0) {
    facts.mm_per_pixel = {pitch_mm[0]};
    if (pitch_mm[1] != pitch_mm[0]) facts.mm_per_pixel.push_back(pitch_mm[1]);
    facts.size_mm = {pitch_mm[0] * plan.size.width, pitch_mm[1] * plan.size.height};
  }
  if (const std::string note = distance_note(files); !note.empty()) facts.notes.push_back(note);
  for (const EncodedFile& file : files) facts.files.push_back(file_facts(plan, file, folder));
  return facts;
}

}  // namespace weft::app
