// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/material/map_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/jobs/maps/maps.h"
#include "app/jobs/material/build.h"
#include "core/albedo_scale.h"
#include "core/files.h"
#include "core/image_io/image_io.h"
#include "core/solve.h"
#include "core/text.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using enum material::Parameter;
using material::Parameter;

// A map of a set that can be a parameter.
struct ScanMap {
  Parameter parameter;
  const char* name;  // as a person names it
  const char* file;
  std::vector<std::string> channels;
  double scale = 1;
  bool is_lobe = false;
  bool is_own = true;  // a scan at the top of a file stands for it
};

const std::vector<ScanMap>& scan_maps() {
  static const std::vector<ScanMap> maps = {
      {kAlbedo, "albedo", "albedo.exr", {"R", "G", "B"}},
      {kNormal, "normal", "normal.exr", {"X", "Y", "Z"}},
      {kHeight, "height", "height.exr", {"height"}},
      {kOcclusion, "occlusion", "occlusion.exr", {"openness"}},
      {kOpacity, "opacity", "opacity.exr", {"opacity"}},
      {kCavity, "cavity", "cavity.exr", {"cavity"}},
      {kRoughness, "roughness", "roughness.exr", {"alpha", "alpha_along", "yarn_deg"}, 1, true},
      {kAnisotropy, "roughness", "roughness.exr", {"alpha", "alpha_along", "yarn_deg"}, 1, true},
      {kAnisotropyDeg, "roughness", "roughness.exr", {"alpha", "alpha_along", "yarn_deg"}, 1, true},
      {kSpecular, "specular", "specular.exr", {"f0"}, 1 / material::kF0OfSpecular},
      {kSpecularTint, "specular_tint", "specular_tint.exr", {"R", "G", "B"}},
      {kMetallic, "metallic", "metallic.exr", {"metallic"}},
      {kSheen, "sheen", "sheen.exr", {"R", "G", "B"}},
      {kSheenRoughness, "sheen_roughness", "sheen_roughness.exr", {"sheen_roughness"}},
      {kCloth, "cloth", "cloth.exr", {"cloth"}},
      {kAlbedo, "detail_albedo", "detail_albedo.exr", {"R", "G", "B"}, 1, false, false},
      {kNormal, "detail_normal", "detail_normal.exr", {"X", "Y", "Z"}, 1, false, false},
      {kHeight, "detail_height", "detail_height.exr", {"height"}, 1, false, false},
  };
  return maps;
}

Error unusable(ErrorKind kind, const std::string& where, std::string why, std::string remedy) {
  return {kind, "the material cannot be used", where, std::move(why), std::move(remedy)};
}

// What a list of maps says of one; null where it says nothing.
const Json* listed(const MapSet& set, const std::string& name) {
  const auto maps = set.document.find("maps");
  if (maps == set.document.end() || !maps->is_array()) return nullptr;
  const auto found = std::ranges::find_if(
      *maps, [&](const Json& map) { return map.is_object() && map.value("name", "") == name; });
  return found == maps->end() ? nullptr : &*found;
}

std::string source_of(const MapSet& set, const std::string& name) {
  const Json* map = listed(set, name);
  const bool is_measured = name == "albedo" || name == "normal";
  return map == nullptr ? (is_measured || name == "roughness" || name == "specular" ? "measured" : "derived")
                        : map->value("source", "assumed");
}

// The solve of a set that lies in its session.
bool has_relative_albedo(const MapSet& set) {
  if (set.document.value("albedo_scale", "") == name_of(AlbedoScale::kRelative)) return true;
  const std::string solve = set.document.value("solve", "");
  const fs::path file = set.folder.parent_path().parent_path() / "solve" / solve / kSolveProduct.document;
  if (solve.empty() || !is_there(file)) return false;
  const Result<Json> document = read_json(file, kSolveProduct.schema, 1);
  return document && document->value("albedo_scale", "") == name_of(AlbedoScale::kRelative);
}

Json provenance_of(const MapSet& set, const fs::path& scan) {
  Json facts = Json::object();
  for (const char* key : {"id", "solve", "rectified"}) {
    if (set.document.contains(key) && set.document[key].is_string())
      facts[key == std::string("id") ? "maps" : key] = set.document[key];
  }
  if (is_there(scan / "session.json")) facts["session"] = scan.filename().string();
  return facts;
}

Result<fs::path> folder_of_maps(const fs::path& scan) {
  if (is_there(scan / kMapsProduct.document) || is_there(scan / kMaterialProduct.document)) return scan;
  const Result<Product> newest = find_product(kMapsProduct, scan / "maps");
  if (newest) return newest->folder;
  return Error{ErrorKind::kNoInput, "there are no maps to take from", scan.string(),
               "it is no session with maps, no set of maps and no built material",
               "make them first with weft maps"};
}

// One number or three, as a set says them in place of a file.
std::optional<std::vector<double>> same_everywhere(const MapSet& set, const ScanMap& map) {
  const auto parameters = set.document.find("parameters");
  const char* name = material::facts_of(map.parameter).name;
  if (parameters != set.document.end() && parameters->contains(name)) {
    const Json& value = (*parameters)[name]["value"];
    return value.is_array() ? value.get<std::vector<double>>() : std::vector<double>{value.get<double>()};
  }
  const Json* facts = listed(set, map.name);
  if (facts == nullptr || !facts->contains("constant")) return {};
  if (!map.is_lobe) return std::vector<double>{map.scale * (*facts)["constant"].get<double>()};
  const double alpha = facts->value("alpha", 1.0), along = facts->value("alpha_along", alpha);
  if (map.parameter == kAnisotropyDeg) return std::vector<double>{0};
  const double broad = std::max(alpha, along);
  return std::vector<double>{map.parameter == kRoughness ? std::sqrt(broad)
                             : broad > 0                 ? 1 - std::min(alpha, along) / broad
                                                         : 0};
}

std::optional<std::array<double, 2>> size_of(const ImageFileInfo& info) {
  const auto mm = info.attributes.find("weft.mm_per_pixel");
  const double each = mm == info.attributes.end() ? 0 : std::strtod(mm->second.c_str(), nullptr);
  const PixelPitch pitch = each > 0 ? PixelPitch{each, each} : info.pitch_mm;
  if (!(pitch[0] > 0 && pitch[0] < 1e3 && pitch[1] > 0 && pitch[1] < 1e3)) return {};
  return std::array<double, 2>{pitch[0] * info.size.width, pitch[1] * info.size.height};
}

void take_words(const Json& value, MapFile& map) {
  if (value.contains("scale")) map.scale = value["scale"].get<double>();
  if (value.contains("offset")) map.offset = value["offset"].get<double>();
  if (value.contains("channel")) map.channels = {value["channel"].get<std::string>()};
  if (value.contains("transfer")) map.is_srgb = value["transfer"] == "srgb";
  if (value.contains("unit")) map.unit = value["unit"].get<std::string>();
  map.y_is_down = value.value("y", "") == "down";
}

Result<MapFile> map_of_file(const Json& value, const std::string& where) {
  MapFile map = {.file = value["map"].get<std::string>()};
  const Result<ImageFileInfo> info = read_image_info(map.file);
  if (!info) {
    Error error = info.error();
    error.where = where + ": " + error.where;
    return error;
  }
  map.size = info->size;
  map.size_mm = size_of(*info);
  const auto source = info->attributes.find("weft.source");
  if (source != info->attributes.end()) map.source = source->second;
  const auto unit = info->attributes.find("weft.unit");
  if (unit != info->attributes.end()) map.unit = unit->second;
  map.provenance = {{"file", map.file.filename().string()}};
  take_words(value, map);
  return map;
}

bool has_map(const MapSet& set, const ScanMap& map) {
  return is_there(set.folder / map.file) || same_everywhere(set, map).has_value();
}

Error no_such_map(const MapSet& set, const std::string& wanted, const std::string& where) {
  std::string names;
  for (const ScanMap& map : scan_maps()) {
    if (has_map(set, map) && names.find(map.name) == std::string::npos)
      names += (names.empty() ? "" : ", ") + std::string(map.name);
  }
  return unusable(ErrorKind::kBadData, where,
                  fmt::format("{} has no map {}; it has {}", set.folder.string(), wanted, names),
                  "name one of these, or make it with weft maps --maps");
}

MapFile file_in(const MapSet& set, const ScanMap& map) {
  MapFile found = {.file = set.folder / map.file,
                   .channels = map.channels,
                   .is_lobe = map.is_lobe,
                   .source = source_of(set, map.name)};
  if (map.scale != 1) found.scale = map.scale;
  if (!is_there(found.file)) {
    found.same = same_everywhere(set, map);
    found.file.clear();
  }
  found.size = set.size;
  found.size_mm = set.size_mm;
  found.is_tile = set.is_tile;
  found.is_of_scan = true;
  found.provenance = set.provenance;
  found.provenance["map"] = map.name;
  return found;
}

Result<MapFile> map_of_scan(std::optional<Parameter> parameter, const Json& value, const std::string& where) {
  const Result<MapSet> set = open_map_set(value["scan"].get<std::string>());
  if (!set) {
    Error error = set.error();
    error.where = where + ": " + error.where;
    return error;
  }
  const std::string wanted = value["map"].get<std::string>();
  const auto is_it = [&](const ScanMap& map) {
    return map.name == wanted && (!parameter || map.parameter == *parameter);
  };
  const auto found = std::ranges::find_if(scan_maps(), is_it);
  if (found == scan_maps().end()) {
    const auto other =
        std::ranges::find(scan_maps(), wanted, [](const ScanMap& map) { return std::string(map.name); });
    if (other == scan_maps().end()) return no_such_map(*set, wanted, where);
    const auto &facts = material::facts_of(*parameter), &others = material::facts_of(other->parameter);
    return unusable(
        ErrorKind::kBadData, where,
        fmt::format("{} is in {}, and the map {} in {}", facts.name, facts.unit, wanted, others.unit),
        "name a map of this parameter");
  }
  if (!has_map(*set, *found)) return no_such_map(*set, wanted, where);
  const bool is_reflectance = parameter == kAlbedo && wanted == "albedo";
  if (is_reflectance && set->is_albedo_relative && !value.contains("scale")) {
    return unusable(
        ErrorKind::kBadData, where, "the albedo of this scan is only relative: it lacks one factor",
        "say scale, which makes it reflectance, or scale = 1 where only its ratio to its mean counts");
  }
  MapFile map = file_in(*set, *found);
  const std::optional<double> own = map.scale;
  take_words(value, map);
  if (own && value.contains("scale")) map.scale = *own * *map.scale;
  return map;
}

}  // namespace

Result<MapSet> open_map_set(const fs::path& scan) {
  const Result<fs::path> folder = folder_of_maps(scan);
  if (!folder) return folder.error();
  MapSet set = {.folder = *folder, .document = {}, .size = {}};
  const bool is_material = is_there(*folder / kMaterialProduct.document);
  const ProductKind kind = is_material ? kMaterialProduct : kMapsProduct;
  const fs::path file = *folder / kind.document;
  Result<Json> document = read_json(file, kind.schema, 1);
  if (!document) return std::move(document).error();
  JsonFields fields(*document, file.string());
  set.size = {fields.integer("width"), fields.integer("height")};
  const double mm = fields.optional_number("mm_per_pixel").value_or(0);
  if (!(set.size.width > 0 && set.size.height > 0)) fields.reject("width", "must be above 0, as height");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  set.is_tile = document->value("is_tile", false);
  if (mm > 0) set.size_mm = {{mm * set.size.width, mm * set.size.height}};
  set.document = std::move(*document);
  if (is_material && set.document.contains("size_mm"))
    set.size_mm = {{set.document["size_mm"][0].get<double>(), set.document["size_mm"][1].get<double>()}};
  set.is_albedo_relative = has_relative_albedo(set);
  set.provenance = provenance_of(set, scan);
  return set;
}

Result<MapFile> find_map(Parameter parameter, const Json& value, const std::string& where) {
  Result<MapFile> map =
      value.contains("scan") ? map_of_scan(parameter, value, where) : map_of_file(value, where);
  if (!map) return map;
  const material::ParameterFacts& facts = material::facts_of(parameter);
  const bool is_other = !map->unit.empty() && map->unit != facts.unit && !map->scale && *facts.unit != 0;
  const bool is_gloss = parameter == kRoughness || parameter == kSheenRoughness;
  if (is_other && !is_gloss) {
    return unusable(
        ErrorKind::kBadData, where,
        fmt::format("it is in {}, and {} in {}", facts.unit, map->file.filename().string(), map->unit),
        "convert the map, or say scale");
  }
  return map;
}

Result<MapFile> find_mask(const Json& value, const std::string& where) {
  return value.contains("scan") ? map_of_scan({}, value, where) : map_of_file(value, where);
}

Result<material::Field> read_built(const MapSet& built, Parameter parameter) {
  const auto map =
      std::ranges::find_if(scan_maps(), [&](const ScanMap& each) { return each.parameter == parameter; });
  const MapFile file = file_in(built, *map);
  if (file.file.empty() && !file.same) {
    const material::ParameterFacts& facts = material::facts_of(parameter);
    return material::Field::same(facts.otherwise, material::numbers_of(facts.kind));
  }
  return read_field(parameter, file, built.folder.string());
}

Result<void> expand_scan(MaterialFile& file) {
  const auto scan = file.top.find("scan");
  if (scan == file.top.end()) return {};
  const std::string folder = scan->second.value.get<std::string>();
  const Result<MapSet> set = open_map_set(folder);
  if (!set) {
    Error error = set.error();
    error.where = file.place.name + ": scan: " + error.where;
    return error;
  }
  const std::string from = scan->second.from;
  for (const ScanMap& map : scan_maps()) {
    const char* name = material::facts_of(map.parameter).name;
    if (!map.is_own || file.surface.contains(name) || !has_map(*set, map)) continue;
    const MapFile found = file_in(*set, map);
    if (found.same && found.source == "assumed" && !is_there(set->folder / kMaterialProduct.document))
      continue;
    file.surface[name] = {Json{{"map", map.name}, {"scan", folder}}, from};
  }
  if (!file.top.contains("size_mm") && set->size_mm)
    file.top["size_mm"] = {Json{(*set->size_mm)[0], (*set->size_mm)[1]}, from};
  if (!file.top.contains("is_tile")) file.top["is_tile"] = {Json(set->is_tile), from};
  file.top.erase("scan");
  return {};
}

}  // namespace weft::app
