// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/export/prepare.h"

#include <utility>

#include "app/jobs/export/price.h"
#include "app/jobs/material/build.h"
#include "app/jobs/material/material_place.h"
#include "core/files.h"
#include "core/text.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// The same with the folder of the built material, where the input is a material's file or name.
Result<ExportOptions> with_built_material(ExportOptions options, const JobContext& context) {
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
  options.material_base = base.string() + "-export";
  return options;
}

}  // namespace

Result<PreparedExport> prepare_export(const ExportOptions& asked, const JobContext& context) {
  Result<ExportOptions> options = with_built_material(asked, context);
  if (!options) return std::move(options).error();
  Result<MapFolder> folder = open_map_folder(options->input, options->maps);
  if (!folder) return std::move(folder).error();
  Result<std::vector<PlannedExport>> plans = plan_exports(*options, *folder);
  if (!plans) return std::move(plans).error();
  if (options->to_deg) {
    Result<void> chosen = choose_bits(*options, *folder, *options->to_deg, *plans, context);
    if (!chosen) return std::move(chosen).error();
  }
  return PreparedExport{std::move(*options), std::move(*folder), std::move(*plans)};
}

}  // namespace weft::app
