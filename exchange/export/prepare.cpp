// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/files.h"
#include "core/base/product.h"
#include "core/base/text.h"
#include "exchange/document.h"
#include "exchange/export/map_planes.h"
#include "exchange/export/preset_files.h"
#include "exchange/presets/channels.h"
#include "exchange/presets/pack.h"
#include "material/assets/build.h"
#include "material/assets/material_place.h"
#include "material/run/derived_maps.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 3;  // raised whenever the bytes of an export may change

Error unfit_export(std::string where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "the maps cannot be exported", std::move(where), std::move(why),
          std::move(remedy)};
}

// The size of the files: what was asked for, else what the preset allows.
Result<Size> size_of(const ExportOptions& options, const MapFolder& folder, const Preset& preset) {
  const int longer = std::max(folder.size.width, folder.size.height);
  if (options.size_px && *options.size_px > longer) {
    return Error{ErrorKind::kBadData, "the maps cannot be exported", "--size",
                 fmt::format("{} pixels are asked for, the maps have {}", *options.size_px, longer),
                 "ask for at most as many: pixels that were not scanned are not made up"};
  }
  const int asked = options.size_px.value_or(preset.most_px);
  if (asked == 0 || asked >= longer) return folder.size;
  const auto side = [&](int px) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(px) * asked / longer)));
  };
  return Size{side(folder.size.width), side(folder.size.height)};
}

PixelPitch pitch_of(const MapFolder& folder, Size size) {
  if (!folder.mm_per_pixel) return {};
  return {*folder.mm_per_pixel * (static_cast<double>(folder.size.width) / size.width),
          *folder.mm_per_pixel * (static_cast<double>(folder.size.height) / size.height)};
}

Result<std::string> name_of(const ExportOptions& options, const MapFolder& folder) {
  const std::string& name = options.name.empty() ? folder.name : options.name;
  const std::string where = options.name.empty() ? "the cloth's name" : "--name";
  if (name.find('/') != std::string::npos)
    return unfit_export(where, fmt::format("\"{}\" has a /, which no file name can", name),
                        "name it without, by --name");
  if (const Result<void> portable = check_portable_path(name); !portable)
    return unfit_export(where, fmt::format("\"{}\": {}", name, portable.error().why),
                        "give another by --name");
  return name;
}

// A file's name with the cloth's in it, which must still be one, and that of no other file.
Result<std::string> file_name(const std::string& pattern, const Preset& preset, const std::string& name,
                              std::set<std::string>& taken) {
  std::string file = named(pattern, name);
  const std::string where = fmt::format("preset {}: {}", preset.name, pattern);
  if (const Result<void> portable = check_portable_path(file); !portable)
    return unfit_export(where, fmt::format("\"{}\": {}", file, portable.error().why), "give another --name");
  if (!taken.insert(small_letters(file)).second)
    return unfit_export(where, fmt::format("\"{}\" is there already, as many disks do not tell case", file),
                        "give another --name");
  return file;
}

Result<void> add_textures(const MapFolder& folder, FilledPreset& filled, std::set<std::string>& taken) {
  const SourcePlanes outline = MapPlanes::outline_of(folder);
  for (const PresetFile& file : filled.preset.files) {
    const Result<void> complete = check_file(file, outline, filled.preset.name);
    if (!complete && !file.is_optional) return complete;
    if (file.is_optional && (!complete || !says_something(file, outline))) continue;
    Result<std::string> name = file_name(file.name, filled.preset, filled.name, taken);
    if (!name) return std::move(name).error();
    filled.textures.push_back({file, std::move(*name)});
  }
  if (!filled.textures.empty()) return {};
  return unfit_export("preset " + filled.preset.name, "the maps have nothing for any of its files",
                      "choose another preset, or make more maps");
}

Result<void> add_documents(const MapFolder& folder, FilledPreset& filled, std::set<std::string>& taken) {
  for (const PresetDocument& document : filled.preset.documents) {
    const bool is_u3m = document.kind == DocumentKind::kU3m || document.kind == DocumentKind::kU3ma;
    const bool lacks = (is_u3m && !folder.mm_per_pixel) ||
                       (document.kind == DocumentKind::kLayers && !folder.document.contains("runtime"));
    if (lacks && document.is_optional) continue;
    if (lacks) {
      return unfit_export(fmt::format("preset {}: {}", filled.preset.name, document.name),
                          is_u3m ? "U3M states millimetres, and nobody knows the size of these maps"
                                 : "the material has no run-time layers",
                          is_u3m ? "export maps of a calibrated rig, or choose glb, mtlx or usd"
                                 : "add [runtime] to it, or mark the document optional = true");
    }
    Result<std::string> name = file_name(document.name, filled.preset, filled.name, taken);
    if (!name) return std::move(name).error();
    filled.documents.push_back({.kind = document.kind, .name = std::move(*name)});
  }
  return {};
}

void add_notes(const MapFolder& folder, FilledPreset& filled) {
  if (!folder.mm_per_pixel)
    filled.notes.emplace_back("The size is not known: these maps state no millimetres.");
  if (folder.mm_per_pixel && !folder.is_size_known) {
    filled.notes.push_back(fmt::format(
        "The size is not known: {:.4g} mm a pixel is assumed. weft export FOLDER --mm-per-pixel says it.",
        *folder.mm_per_pixel));
  }
  if (folder.albedo_scale == "relative")
    filled.notes.emplace_back("The albedo is relative: it lacks one common factor to be a reflectance.");
  if (!folder.is_tile)
    filled.notes.emplace_back("The maps are no tile: they do not go on over their borders.");
}

// The digest of each map's file that the textures are made of.
Result<Json> digests_of(const MapFolder& folder, const FilledPreset& filled) {
  std::set<std::string> files;
  for (const TextureToWrite& texture : filled.textures) {
    for (const std::string& name : texture.file.channels) {
      for (const MapPlane plane : channel_named(name)->planes) files.insert(origin_of(folder, plane).file);
    }
  }
  files.erase("");
  Json digests = Json::object();
  for (const std::string& file : files) {
    const Result<std::string> digest = sha256_of_file(folder.folder / file);
    if (!digest) return digest.error();
    digests[file] = *digest;
  }
  return digests;
}

Json json_of(const PresetFile& file) {
  return {{"name", file.name},
          {"channels", file.channels},
          {"stored", words_of(file.stored)},
          {"color", kColorSpaceNames[static_cast<std::size_t>(file.stored.color)]},
          {"prman", file.stored.is_prman},
          {"direction", kNormalDirectionNames[static_cast<std::size_t>(file.direction)]}};
}

Result<Json> inputs_of(const ExportOptions& options, const MapFolder& folder, const FilledPreset& filled) {
  Result<Json> digests = digests_of(folder, filled);
  if (!digests) return digests;
  const Result<std::string> document = sha256_of_file(folder.folder / folder.document_file);
  if (!document) return document.error();
  Json files = Json::array();
  for (const TextureToWrite& texture : filled.textures) files.push_back(json_of(texture.file));
  Json documents = Json::array();
  for (const PresetDocument& each : filled.documents) documents.push_back(each.name);
  return Json{{"version", kVersion},
              {"preset", filled.preset.name},
              {"roughness", kRoughnessConventionNames[static_cast<std::size_t>(filled.preset.roughness)]},
              {"files", std::move(files)},
              {"documents", std::move(documents)},
              {"of", *document},
              {"maps", std::move(*digests)},
              {"name", filled.name},
              {"title", filled.title},
              {"width", filled.size.width},
              {"height", filled.size.height},
              {"dx10", options.is_dx10}};
}

fs::path folder_of(const ExportOptions& options, const MapFolder& folder, const std::string& preset) {
  if (!options.output.empty()) {
    const fs::path output = fs::absolute(options.output).lexically_normal();
    return options.presets.size() == 1 ? output : output / preset;
  }
  if (!options.material_base.empty()) return options.material_base / preset;
  const fs::path base = folder.session ? folder.session->folder : folder.folder;
  return absolute_folder(base) / "export" / preset;
}

Result<FilledPreset> fill_preset(const ExportOptions& options, const MapFolder& folder, Preset preset) {
  FilledPreset filled;
  filled.preset = std::move(preset);
  Result<std::string> name = name_of(options, folder);
  if (!name) return std::move(name).error();
  filled.name = std::move(*name);
  filled.title = options.name.empty() ? folder.title : options.name;
  const Result<Size> size = size_of(options, folder, filled.preset);
  if (!size) return size.error();
  filled.size = *size;
  filled.pitch_mm = pitch_of(folder, filled.size);
  std::set<std::string> taken = {"export.json"};
  if (Result<void> ok = add_textures(folder, filled, taken); !ok) return std::move(ok).error();
  if (Result<void> ok = add_documents(folder, filled, taken); !ok) return std::move(ok).error();
  add_notes(folder, filled);
  filled.folder = folder_of(options, folder, filled.preset.name);
  return filled;
}

Result<std::vector<FilledPreset>> fill_presets(const ExportOptions& options, const MapFolder& folder) {
  std::vector<FilledPreset> presets;
  std::set<fs::path> folders;
  for (const std::string& name : options.presets) {
    Result<Preset> preset = read_preset(name);
    if (!preset) return std::move(preset).error();
    Result<FilledPreset> filled = fill_preset(options, folder, std::move(*preset));
    if (!filled) return std::move(filled).error();
    if (!folders.insert(filled->folder).second) {
      return Error{ErrorKind::kUsage, "the maps cannot be exported", "--preset",
                   fmt::format("{} stands twice", filled->preset.name), "name each preset once"};
    }
    presets.push_back(std::move(*filled));
  }
  return presets;
}

// The same with the folder of the built material, where the input is a material's file or name. `scans`: what
// it is made of, as that is today.
Result<ExportOptions> with_built_material(ExportOptions options, Json& scans, const JobContext& context) {
  const std::string written = options.input.string();
  const bool is_library = written.starts_with(material::kLibraryPrefix);
  if (!is_library && (!written.ends_with(".toml") || !is_there(options.input))) return options;
  const Result<material::MaterialPlace> place = material::find_material(written, fs::current_path());
  if (!place) return place.error();
  const fs::path base =
      is_library ? fs::absolute(plain_name(written)) : fs::absolute(options.input).replace_extension();
  material::BuildOptions build;
  build.materials = {*place};
  if (place->is_shipped()) build.output = base.string() + "-build";
  const Result<material::BuildReport> built = material::build_materials(build, context);
  if (!built) return built.error();
  options.input = built->materials.front().folder;
  scans = built->materials.front().document["scans"];
  options.material_base = base.string() + "-export";
  return options;
}

// The preset's textures of one layer, below a folder of its name.
Result<FilledPreset> fill_layer(const FilledPreset& filled, const material::RuntimeLayer& layer,
                                const MapFolder& maps) {
  Preset preset = filled.preset;
  preset.documents.clear();
  const std::string name = file_name_of(layer.name, "layer");
  for (PresetFile& file : preset.files)
    file.name = fmt::format("layers/{}/{}", name, fs::path(file.name).filename().string());
  ExportOptions options = {.input = layer.folder, .name = name};
  options.presets = {preset.name};
  return fill_preset(options, maps, std::move(preset));
}

}  // namespace

std::vector<std::string> needed_maps(const std::vector<std::string>& presets) {
  std::set<std::string> needed;
  for (const std::string& name : presets) {
    const Result<Preset> preset = read_preset(name);
    if (!preset) continue;  // fill_preset() says why
    for (const PresetFile& file : preset->files) {
      for (const std::string& channel : file.channels) {
        const Channel* const known = channel_named(channel);
        if (known == nullptr || file.is_optional) continue;
        for (const MapPlane plane : known->planes) needed.insert(kind_of(plane).map);
      }
    }
  }
  std::vector<std::string> derived;
  for (const material::DerivedMap& map : material::derived_maps()) {
    if (needed.contains(map.name) && std::string_view(map.name) != "opacity") derived.emplace_back(map.name);
  }
  return derived;
}

Result<PreparedExport> prepare_export(const ExportOptions& asked, const JobContext& context) {
  Json scans;
  Result<ExportOptions> options = with_built_material(asked, scans, context);
  if (!options) return std::move(options).error();
  Result<MapFolder> folder = open_map_folder({.input = options->input,
                                              .maps_id = options->maps,
                                              .wanted = needed_maps(options->presets),
                                              .is_draft = options->is_draft});
  if (!folder) return std::move(folder).error();
  if (!scans.is_null()) folder->document["scans"] = std::move(scans);
  Result<std::vector<FilledPreset>> presets = fill_presets(*options, *folder);
  if (!presets) return std::move(presets).error();
  return PreparedExport{std::move(*options), std::move(*folder), std::move(*presets)};
}

Result<void> identify(PreparedExport& prepared) {
  for (FilledPreset& preset : prepared.presets) {
    Result<Json> inputs = inputs_of(prepared.options, prepared.folder, preset);
    if (!inputs) return std::move(inputs).error();
    preset.inputs = std::move(*inputs);
    preset.id = product_id(preset.inputs);
  }
  return {};
}

std::uint64_t most_bytes(const FilledPreset& preset) {
  std::uint64_t bytes = 1 << 20;
  const auto pixels = static_cast<std::uint64_t>(preset.size.pixels());
  for (const TextureToWrite& texture : preset.textures) {
    const auto bits = static_cast<std::uint64_t>(texture.file.stored.bits);
    bytes += pixels * texture.file.channels.size() * bits / 8 * 3 / 2;
  }
  return preset.documents.empty() ? bytes : 2 * bytes;
}

Result<LayersToWrite> layers_of(const FilledPreset& preset, const MapFolder& maps) {
  LayersToWrite found;
  if (std::ranges::find(preset.documents, DocumentKind::kLayers, &PresetDocument::kind) ==
      preset.documents.end())
    return found;
  Result<material::RuntimeStack> stack = material::runtime_stack_of(maps.folder);
  if (!stack) return std::move(stack).error();
  found.stack = std::move(*stack);
  for (std::size_t i = 1; i < found.stack.layers.size(); ++i) {
    const material::RuntimeLayer& layer = found.stack.layers[i];
    Result<MapFolder> own = open_map_folder({.input = layer.folder, .is_draft = true});
    if (!own) return std::move(own).error();
    Result<FilledPreset> filled = fill_layer(preset, layer, *own);
    if (!filled) return std::move(filled).error();
    found.layers.push_back({std::move(*own), std::move(*filled)});
  }
  return found;
}

}  // namespace weft::exchange
