// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/prepare.h"

#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/base/text.h"
#include "exchange/export/preset_files.h"
#include "exchange/export/price.h"
#include "exchange/presets/channels.h"
#include "material/assets/build.h"
#include "material/assets/material_place.h"
#include "material/run/map_work.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// The same with the folder of the built material, where the input is a material's file or name. `scans`: what
// it is made of, as that is today.
Result<ExportOptions> with_built_material(ExportOptions options, Json& scans, const JobContext& context) {
  const std::string written = options.input.string();
  const bool is_library = written.starts_with(kLibraryPrefix);
  if (!is_library && (!written.ends_with(".toml") || !is_there(options.input))) return options;
  const Result<MaterialPlace> place = find_material(written, fs::current_path());
  if (!place) return place.error();
  const fs::path base =
      is_library ? fs::absolute(plain_name(written)) : fs::absolute(options.input).replace_extension();
  BuildOptions build;
  build.materials = {*place};
  if (place->is_shipped()) build.output = base.string() + "-build";
  const Result<BuildReport> built = build_materials(build, context);
  if (!built) return built.error();
  options.input = built->materials.front().folder;
  scans = built->materials.front().document["scans"];
  options.material_base = base.string() + "-export";
  return options;
}

// Maps that files of the presets cannot do without, and that not every set has.
std::vector<std::string> needed_maps(const ExportOptions& options) {
  std::set<std::string> needed;
  for (const std::string& name : options.presets) {
    const Result<exchange::Preset> preset = read_preset(name);
    if (!preset) continue;  // planning says why
    for (const exchange::PresetFile& file : preset->files) {
      for (const std::string& channel : file.channels) {
        const exchange::Channel* const known = exchange::channel_named(channel);
        if (known == nullptr || file.is_optional) continue;
        for (const exchange::Plane plane : known->planes) needed.insert(exchange::kind_of(plane).map);
      }
    }
  }
  std::vector<std::string> derived;
  for (const DerivedMap& map : derived_maps()) {
    if (needed.contains(map.name) && std::string_view(map.name) != "opacity") derived.emplace_back(map.name);
  }
  return derived;
}

}  // namespace

Result<PreparedExport> prepare_export(const ExportOptions& asked, const JobContext& context) {
  Json scans;
  Result<ExportOptions> options = with_built_material(asked, scans, context);
  if (!options) return std::move(options).error();
  Result<MapFolder> folder = open_map_folder({.input = options->input,
                                              .maps_id = options->maps,
                                              .wanted = needed_maps(*options),
                                              .is_draft = options->is_draft});
  if (!folder) return std::move(folder).error();
  if (!scans.is_null()) folder->document["scans"] = std::move(scans);
  Result<std::vector<PlannedExport>> plans = plan_exports(*options, *folder);
  if (!plans) return std::move(plans).error();
  if (options->to_deg) {
    Result<void> chosen = choose_bits(*options, *folder, *options->to_deg, *plans, context);
    if (!chosen) return std::move(chosen).error();
  }
  return PreparedExport{std::move(*options), std::move(*folder), std::move(*plans)};
}

}  // namespace weft::app
