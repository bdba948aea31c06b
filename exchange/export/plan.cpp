// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/files.h"
#include "exchange/document.h"
#include "exchange/export/map_planes.h"
#include "exchange/export/preset_files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using exchange::DocumentKind;
using exchange::Preset;

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
  return {*folder.mm_per_pixel * folder.size.width / size.width,
          *folder.mm_per_pixel * folder.size.height / size.height};
}

Result<std::string> name_of(const ExportOptions& options, const MapFolder& folder) {
  const std::string& name = options.name.empty() ? folder.name : options.name;
  const std::string where = options.name.empty() ? "the cloth's name" : "--name";
  if (name.find('/') != std::string::npos)
    return unfit_export(where, fmt::format("\"{}\" has a /, which no file name can", name),
                        "name it without, by --name");
  if (const Result<void> portable = exchange::check_portable_path(name); !portable)
    return unfit_export(where, fmt::format("\"{}\": {}", name, portable.error().why),
                        "give another by --name");
  return name;
}

// A file's name with the cloth's in it, which must still be one, and that of no other file.
Result<std::string> file_name(const std::string& pattern, const Preset& preset, const std::string& name,
                              std::set<std::string>& taken) {
  std::string file = exchange::named(pattern, name);
  const std::string where = fmt::format("preset {}: {}", preset.name, pattern);
  if (const Result<void> portable = exchange::check_portable_path(file); !portable)
    return unfit_export(where, fmt::format("\"{}\": {}", file, portable.error().why), "give another --name");
  std::string folded = file;
  std::ranges::transform(folded, folded.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!taken.insert(folded).second)
    return unfit_export(where, fmt::format("\"{}\" is there already, as many disks do not tell case", file),
                        "give another --name");
  return file;
}

Result<void> add_files(const MapFolder& folder, PlannedExport& plan, std::set<std::string>& taken) {
  const exchange::SourcePlanes outline = MapPlanes::outline_of(folder);
  for (const exchange::PresetFile& file : plan.preset.files) {
    const Result<void> complete = exchange::check_file(file, outline, plan.preset.name);
    if (!complete && !file.is_optional) return complete;
    if (file.is_optional && (!complete || !exchange::says_something(file, outline))) continue;
    Result<std::string> name = file_name(file.name, plan.preset, plan.name, taken);
    if (!name) return std::move(name).error();
    plan.files.push_back({file, std::move(*name)});
  }
  if (!plan.files.empty()) return {};
  return unfit_export("preset " + plan.preset.name, "the maps have nothing for any of its files",
                      "choose another preset, or make more maps");
}

Result<void> add_documents(const MapFolder& folder, PlannedExport& plan, std::set<std::string>& taken) {
  for (const exchange::PresetDocument& document : plan.preset.documents) {
    const bool is_u3m = document.kind == DocumentKind::kU3m || document.kind == DocumentKind::kU3ma;
    const bool lacks = (is_u3m && !folder.mm_per_pixel) ||
                       (document.kind == DocumentKind::kLayers && !folder.document.contains("runtime"));
    if (lacks && document.is_optional) continue;
    if (lacks) {
      return unfit_export(fmt::format("preset {}: {}", plan.preset.name, document.name),
                          is_u3m ? "U3M states millimetres, and nobody knows the size of these maps"
                                 : "the material has no run-time layers",
                          is_u3m ? "export maps of a calibrated rig, or choose glb, mtlx or usd"
                                 : "add [runtime] to it, or mark the document optional = true");
    }
    Result<std::string> name = file_name(document.name, plan.preset, plan.name, taken);
    if (!name) return std::move(name).error();
    plan.documents.push_back({document.kind, std::move(*name)});
  }
  return {};
}

void add_notes(const MapFolder& folder, PlannedExport& plan) {
  if (!folder.mm_per_pixel)
    plan.notes.emplace_back("The size is not known: these maps state no millimetres.");
  if (folder.albedo_scale == "relative")
    plan.notes.emplace_back("The albedo is relative: it lacks one common factor to be a reflectance.");
  if (!folder.is_tile) plan.notes.emplace_back("The maps are no tile: they do not go on over their borders.");
}

// The digest of each map's file that the plan reads.
Result<Json> digests_of(const MapFolder& folder, const PlannedExport& plan) {
  std::set<std::string> files;
  for (const PlannedFile& planned : plan.files) {
    for (const std::string& name : planned.file.channels) {
      for (const exchange::Plane plane : exchange::channel_named(name)->planes)
        files.insert(origin_of(folder, plane).file);
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

Json json_of(const exchange::PresetFile& file) {
  return {{"name", file.name},
          {"channels", file.channels},
          {"stored", words_of(file.stored)},
          {"color", exchange::kColorSpaceNames[static_cast<std::size_t>(file.stored.color)]},
          {"prman", file.stored.is_prman},
          {"direction", exchange::kNormalDirectionNames[static_cast<std::size_t>(file.direction)]}};
}

Result<Json> inputs_of(const ExportOptions& options, const MapFolder& folder, const PlannedExport& plan) {
  Result<Json> digests = digests_of(folder, plan);
  if (!digests) return digests;
  const Result<std::string> document = sha256_of_file(folder.folder / folder.document_file);
  if (!document) return document.error();
  Json files = Json::array();
  for (const PlannedFile& file : plan.files) files.push_back(json_of(file.file));
  Json documents = Json::array();
  for (const PlannedDocument& each : plan.documents) documents.push_back(each.name);
  return Json{
      {"version", kVersion},
      {"preset", plan.preset.name},
      {"roughness", exchange::kRoughnessConventionNames[static_cast<std::size_t>(plan.preset.roughness)]},
      {"files", std::move(files)},
      {"documents", std::move(documents)},
      {"of", *document},
      {"maps", std::move(*digests)},
      {"name", plan.name},
      {"title", plan.title},
      {"width", plan.size.width},
      {"height", plan.size.height},
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

}  // namespace

Result<PlannedExport> plan_preset(const ExportOptions& options, const MapFolder& folder, Preset preset) {
  PlannedExport plan;
  plan.preset = std::move(preset);
  Result<std::string> name = name_of(options, folder);
  if (!name) return std::move(name).error();
  plan.name = std::move(*name);
  plan.title = options.name.empty() ? folder.title : options.name;
  const Result<Size> size = size_of(options, folder, plan.preset);
  if (!size) return size.error();
  plan.size = *size;
  plan.pitch_mm = pitch_of(folder, plan.size);
  std::set<std::string> taken = {"export.json"};
  if (Result<void> ok = add_files(folder, plan, taken); !ok) return std::move(ok).error();
  if (Result<void> ok = add_documents(folder, plan, taken); !ok) return std::move(ok).error();
  add_notes(folder, plan);
  plan.folder = folder_of(options, folder, plan.preset.name);
  if (Result<void> ok = seal(options, folder, plan); !ok) return std::move(ok).error();
  return plan;
}

Result<void> seal(const ExportOptions& options, const MapFolder& folder, PlannedExport& plan) {
  Result<Json> inputs = inputs_of(options, folder, plan);
  if (!inputs) return std::move(inputs).error();
  plan.inputs = std::move(*inputs);
  plan.id = product_id(plan.inputs);
  return {};
}

Result<std::vector<PlannedExport>> plan_exports(const ExportOptions& options, const MapFolder& folder) {
  std::vector<PlannedExport> plans;
  std::set<fs::path> folders;
  for (const std::string& name : options.presets) {
    Result<Preset> preset = read_preset(name);
    if (!preset) return std::move(preset).error();
    Result<PlannedExport> plan = plan_preset(options, folder, std::move(*preset));
    if (!plan) return std::move(plan).error();
    if (!folders.insert(plan->folder).second) {
      return Error{ErrorKind::kUsage, "the maps cannot be exported", "--preset",
                   fmt::format("{} stands twice", plan->preset.name), "name each preset once"};
    }
    plans.push_back(std::move(*plan));
  }
  return plans;
}

std::uint64_t most_bytes(const PlannedExport& plan) {
  std::uint64_t bytes = 1 << 20;
  const auto pixels = static_cast<std::uint64_t>(plan.size.pixels());
  for (const PlannedFile& file : plan.files) {
    const auto bits = static_cast<std::uint64_t>(file.file.stored.bits);
    bytes += pixels * file.file.channels.size() * bits / 8 * 3 / 2;
  }
  return plan.documents.empty() ? bytes : 2 * bytes;
}

}  // namespace weft::app
