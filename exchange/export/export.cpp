// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/export.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/product.h"
#include "exchange/export/documents.h"
#include "exchange/export/encode_files.h"
#include "exchange/export/export_price.h"
#include "exchange/export/prepare.h"
#include "exchange/export/textured.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

Error is_taken(const fs::path& folder, std::string why) {
  return {ErrorKind::kCannotCreate, "output folder is taken", folder.string(), std::move(why),
          "name another folder with -o, or remove it"};
}

// What lies where an export is to go: nothing, an export that may be replaced, or an error for anything else.
Result<std::optional<ExportFacts>> earlier_export(const fs::path& folder) {
  if (!is_there(folder)) return std::optional<ExportFacts>();
  if (!is_there(folder / kExportProduct.document)) {
    std::error_code failed;
    if (fs::is_directory(folder, failed) && fs::is_empty(folder, failed) && !failed)
      return std::optional<ExportFacts>();
    return is_taken(folder, "it holds something other than an export");
  }
  Result<ExportFacts> facts = read_export(folder);
  if (!facts) return std::move(facts).error();
  std::set<std::string> ours = {kExportProduct.document};
  for (const ExportedTexture& each : facts->files) ours.insert(each.file);
  for (const ExportedDocument& each : facts->documents) ours.insert(each.name);
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, failed)) {
    const std::string name = fs::relative(entry.path(), folder, failed).generic_string();
    if (!entry.is_directory() && !ours.contains(name))
      return is_taken(folder, fmt::format("beside an earlier export it holds {}", name));
  }
  if (failed) return cannot_read(folder, failed.value());
  return std::optional<ExportFacts>(std::move(*facts));
}

// Whether every file that the document names is there.
bool is_whole(const fs::path& folder, const ExportFacts& facts) {
  return std::ranges::all_of(facts.files,
                             [&](const ExportedTexture& each) {
                               return !each.inside.empty() || is_there(folder / each.file);
                             }) &&
         std::ranges::all_of(facts.documents,
                             [&](const ExportedDocument& each) { return is_there(folder / each.name); });
}

// An earlier export goes only once the new one is whole, and comes back where that cannot take its place.
Result<void> publish(PartialFolder& partial, const fs::path& target) {
  if (!is_there(target)) return partial.publish();
  const fs::path old =
      target.parent_path() / fmt::format(".{}.old-{}", target.filename().string(), ::getpid());
  std::error_code failed;
  fs::rename(target, old, failed);
  if (failed) return cannot_write(target, failed.value());
  Result<void> published = partial.publish();
  if (!published) {
    fs::rename(old, target, failed);
    return published;
  }
  fs::remove_all(old, failed);
  return {};
}

// A preset on its way to its folder.
struct Work {
  const FilledPreset* preset = nullptr;
  ExportReport report;
  LayersToWrite layers = {};
  std::unique_ptr<PartialFolder> partial = {};
  EncodedTextures textures = {};
  std::vector<EncodedTextures> of_layers = {};
};

// What is there already needs no work.
Result<Work> begun(const FilledPreset& preset, const MapFolder& folder) {
  Work work = {.preset = &preset, .report = {.folder = preset.folder, .source = source_of(folder)}};
  Result<std::optional<ExportFacts>> earlier = earlier_export(preset.folder);
  if (!earlier) return std::move(earlier).error();
  if (*earlier && (*earlier)->id == preset.id && is_whole(preset.folder, **earlier)) {
    work.report.was_there = true;
    work.report.facts = std::move(**earlier);
    return work;
  }
  Result<LayersToWrite> layers = layers_of(preset, folder);
  if (!layers) return std::move(layers).error();
  work.layers = std::move(*layers);
  return work;
}

// A folder aside for each, with room on its disk.
Result<void> make_room(const std::vector<Work*>& works) {
  // Each knows which parents were not there before any of them.
  for (Work* work : works) work->partial = std::make_unique<PartialFolder>(work->preset->folder);
  std::uint64_t bytes = 0;
  for (const Work* work : works) {
    bytes += most_bytes(*work->preset);
    if (Result<void> ok = begin(*work->partial, bytes); !ok) return ok;
  }
  return {};
}

// The cloth's own for all presets together, then those of layers.
Result<void> encode(const std::vector<Work*>& works, const PreparedExport& prepared,
                    const JobContext& context) {
  std::vector<EncodeTarget> targets;
  for (const Work* work : works) targets.push_back({work->preset, work->partial->path()});
  Result<std::vector<EncodedTextures>> own =
      encode_files(prepared.folder, targets, prepared.options.is_dx10, context);
  if (!own) return std::move(own).error();
  for (std::size_t i = 0; i < works.size(); ++i) {
    works[i]->textures = std::move((*own)[i]);
    for (const LayerToWrite& layer : works[i]->layers.layers) {
      Result<std::vector<EncodedTextures>> of_layer =
          encode_files(layer.maps, {{&layer.preset, targets[i].folder}}, false, context);
      if (!of_layer) return std::move(of_layer).error();
      works[i]->of_layers.push_back(std::move(of_layer->front()));
    }
  }
  return {};
}

Result<std::vector<ExportedDocument>> documents_of(const Work& work, const MapFolder& folder) {
  ClothLayers layers = {work.layers.stack, {}};
  for (std::size_t i = 0; i < work.of_layers.size(); ++i) {
    const LayerToWrite& layer = work.layers.layers[i];
    layers.above.push_back({layer.maps, layer.preset, work.of_layers[i].textures});
  }
  return write_documents({folder, *work.preset, work.textures.textures}, layers, work.partial->path());
}

// Textures of one number, which the documents say and no document names.
void drop_numbers(const std::vector<ExportedDocument>& documents, const fs::path& folder,
                  std::vector<ExportedTexture>& textures) {
  if (documents.empty()) return;
  std::vector<std::string> named;
  for (const ExportedDocument& document : documents)
    named.insert(named.end(), document.files.begin(), document.files.end());
  const auto is_dropped = [&](const ExportedTexture& texture) { return is_said_as_number(texture, named); };
  for (const ExportedTexture& texture : textures) {
    std::error_code ignored;
    if (is_dropped(texture)) fs::remove(folder / texture.file, ignored);
    if (is_dropped(texture)) fs::remove((folder / texture.file).parent_path(), ignored);  // where it is empty
  }
  std::erase_if(textures, is_dropped);
}

// The source of the map that a channel comes from; "assumed" where it comes from none.
std::string source_of_channel(const MapFolder& folder, const Channel& channel) {
  for (const MapPlane plane : channel.planes) {
    const std::string name = kind_of(plane).map;
    const material::MapFacts* map = folder.map(name);
    if (map == nullptr && name == "specular") map = folder.map("f0");
    if (map != nullptr) return name_of(map->source);
  }
  return "assumed";
}

// What becomes of roughness some eight times as far, where engines make the mips; empty where they are right
// to 2 percent.
std::string distance_note(const std::vector<ExportedTexture>& textures) {
  constexpr double kNothing = 0.02;
  for (const ExportedTexture& texture : textures) {
    const DistanceLoss* seen = nullptr;
    for (const DistanceLoss& each : texture.lost.by_distance) {
      if (each.level <= kToldDistance) seen = &each;
    }
    if (seen == nullptr || seen->mean_abs <= kNothing * seen->mean) continue;
    return fmt::format(
        "Seen from {} times as far an engine's own mips of {} have {:.3g} in the mean where the cloth has "
        "{:.3g}: they lose the spread of normals. The presets dds, order1886, arnold and renderman hold mips "
        "that keep it.",
        1 << seen->level, texture.file, seen->engine, seen->mean);
  }
  return {};
}

ExportFacts export_facts(const FilledPreset& preset, const MapFolder& folder, const Json& provenance,
                         std::vector<ExportedTexture> textures, std::vector<ExportedDocument> documents) {
  ExportFacts facts = {
      .id = preset.id,
      .preset = preset.preset.name,
      .name = preset.name,
      .title = preset.title,
      .normal = preset.preset.normal,
      .roughness = kRoughnessConventionNames[static_cast<std::size_t>(preset.preset.roughness)],
      .size = preset.size,
      .is_size_known = folder.is_size_known,
      .is_tile = folder.is_tile,
      .albedo_scale = folder.albedo_scale,
      .notes = preset.notes,
      .documents = std::move(documents),
      .from = provenance};
  if (const auto& pitch_mm = preset.pitch_mm; pitch_mm[0] > 0) {
    facts.mm_per_pixel = {pitch_mm[0]};
    if (pitch_mm[1] != pitch_mm[0]) facts.mm_per_pixel.push_back(pitch_mm[1]);
    facts.size_mm = {pitch_mm[0] * preset.size.width, pitch_mm[1] * preset.size.height};
  }
  if (const std::string note = distance_note(textures); !note.empty()) facts.notes.push_back(note);
  for (ExportedTexture& texture : textures) {
    for (ExportedChannel& channel : texture.channels)
      channel.source = source_of_channel(folder, *channel_named(channel.name));
    if (preset.preset.keeps_no_files()) texture.inside = preset.documents.front().name;
  }
  facts.files = std::move(textures);
  return facts;
}

Result<void> finish(Work& work, const MapFolder& folder, const Json& provenance) {
  Stopwatch watch;
  const fs::path& aside = work.partial->path();
  Result<std::vector<ExportedDocument>> documents = documents_of(work, folder);
  if (!documents) return std::move(documents).error();
  std::vector<ExportedTexture> textures = std::move(work.textures.textures);
  work.report.seconds = work.textures.seconds;
  for (EncodedTextures& layer : work.of_layers) {
    std::ranges::move(layer.textures, std::back_inserter(textures));
    work.report.seconds += layer.seconds;
  }
  drop_numbers(*documents, aside, textures);
  work.report.facts =
      export_facts(*work.preset, folder, provenance, std::move(textures), std::move(*documents));
  if (Result<void> ok = write_json(aside / kExportProduct.document, json_of(work.report.facts)); !ok)
    return ok;
  work.report.seconds += watch.lap();
  return {};
}

Result<void> make_all(const std::vector<Work*>& works, const PreparedExport& prepared,
                      const JobContext& context) {
  if (Result<void> ok = make_room(works); !ok) return ok;
  const Result<Json> provenance = provenance_of(prepared.folder);
  if (!provenance) return provenance.error();
  if (Result<void> ok = encode(works, prepared, context); !ok) return ok;
  for (Work* work : works) {
    if (Result<void> ok = finish(*work, prepared.folder, *provenance); !ok) return ok;
  }
  for (Work* work : works) {
    if (context.stop.stop_requested()) return interrupted();
    if (Result<void> ok = publish(*work->partial, work->preset->folder); !ok) return ok;
  }
  return {};
}

}  // namespace

Result<std::vector<ExportReport>> export_maps(const ExportOptions& asked, const JobContext& context) {
  Result<PreparedExport> prepared = prepare_export(asked, context);
  if (!prepared) return std::move(prepared).error();
  if (Result<void> ok = choose_bits(*prepared, context); !ok) return std::move(ok).error();
  if (Result<void> ok = identify(*prepared); !ok) return std::move(ok).error();
  std::vector<Work> works;
  for (const FilledPreset& preset : prepared->presets) {
    Result<Work> work = begun(preset, prepared->folder);
    if (!work) return std::move(work).error();
    works.push_back(std::move(*work));
  }
  std::vector<Work*> wanted;
  for (Work& work : works) {
    if (!work.report.was_there) wanted.push_back(&work);
  }
  if (!wanted.empty()) {
    if (Result<void> ok = make_all(wanted, *prepared, context); !ok) return std::move(ok).error();
  }
  std::vector<ExportReport> reports;
  for (Work& work : works) reports.push_back(std::move(work.report));
  context.progress("encode", 1);
  return reports;
}

}  // namespace weft::exchange
