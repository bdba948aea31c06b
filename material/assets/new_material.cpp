// SPDX-License-Identifier: Apache-2.0
#include "material/assets/new_material.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <map>
#include <sstream>

#include "core/base/files.h"
#include "material/assets/map_set.h"
#include "material/assets/material_file.h"
#include "material/assets/resolve.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

// A text of TOML in its quotes.
std::string quoted_text(const std::string& text) {
  std::ostringstream out;
  out << toml::value<std::string>(text);
  return out.str();
}

std::string as_written(const std::string& name, const fs::path& folder) {
  if (name.starts_with(kLibraryPrefix)) return name;
  const fs::path relative = fs::absolute(name).lexically_normal().lexically_proximate(folder);
  return relative.generic_string();
}

}  // namespace

std::string text_of(const NewMaterial& material) {
  const fs::path folder = fs::absolute(material.file).lexically_normal().parent_path();
  std::string text = fmt::format("schema = \"{}/1\"\n", kMaterialSchema);
  if (!material.inherits.empty())
    text += fmt::format("inherits = {}\n", quoted_text(as_written(material.inherits, folder)));
  if (!material.scan.empty())
    text += fmt::format("scan = {}\n", quoted_text(as_written(material.scan.string(), folder)));
  if (material.is_draft) text += "draft = true\n";
  text += "\n[surface]\n";
  if (material.inherits.empty() && material.scan.empty())
    text += "albedo = [0.5, 0.5, 0.5]\nroughness = 0.7\n";
  if (material.is_albedo_relative) {
    text += "# relative: scale is the factor that makes a reflectance of it\n";
    text += fmt::format("albedo = {{ map = \"albedo\", scan = {}, scale = 1{} }}\n",
                        quoted_text(as_written(material.scan.string(), folder)),
                        material.is_draft ? ", draft = true" : "");
  }
  std::map<std::string, int> names;
  for (const std::string& layer : material.layers) {
    std::string name = fs::path(layer.substr(layer.rfind(':') + 1)).stem().string();
    if (const int count = ++names[name]; count > 1) name += fmt::format("-{}", count);
    text += fmt::format("\n[[layer]]\nname = {}\nmaterial = {}\n", quoted_text(name),
                        quoted_text(as_written(layer, folder)));
    if (layer.find("dirt/") == std::string::npos && name != "dust") continue;
    // Without a scan there is no height that a mask could follow.
    text += material.scan.empty() ? "mask = 0.3\n"
                                  : "mask = { from = \"height\", kind = \"cavity\", radius_mm = 0.5 }\n";
    text += "only = [\"albedo\", \"roughness\", \"specular\", \"cloth\", \"sheen\", \"sheen_roughness\"]\n";
  }
  return text;
}

Result<void> write_new_material(const NewMaterial& asked) {
  NewMaterial material = asked;
  if (const Result<MapSet> set = open_map_set(asked.scan, asked.is_draft); set && !asked.scan.empty())
    material.is_albedo_relative = set->is_albedo_relative;
  const fs::path file = fs::absolute(material.file).lexically_normal();
  if (is_there(file)) {
    return Error{ErrorKind::kCannotCreate, "there is such a file", file.string(), "it would be lost",
                 "give another name, or edit it"};
  }
  const std::string text = text_of(material);
  const MaterialPlace place = {file.string(), file};
  MaterialSource source = materials_on_disk();
  const auto read = source.read;
  source.read = [&](const MaterialPlace& each) -> Result<MaterialFile> {
    if (!(each == place)) return read(each);
    Result<MaterialFile> parsed = parse_material(text, place);
    if (!parsed) return parsed;
    if (Result<void> ok = expand_scan(*parsed); !ok) return std::move(ok).error();
    return parsed;
  };
  const Result<ResolvedMaterial> resolved = resolve_material(place, source);
  if (!resolved) return resolved.error();
  for (const MaterialLayer& layer : resolved->layers) {
    const Result<MaterialPlace> found = source.find(layer.values.at("material").value.get<std::string>(), {});
    if (!found) return found.error();
  }
  if (Result<void> ok = make_writable_folder(file.parent_path()); !ok) return ok;
  return write_file(file, text);
}

}  // namespace weft::material
