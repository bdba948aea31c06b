// SPDX-License-Identifier: Apache-2.0
#include "material/assets/map_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/files.h"
#include "core/base/number.h"
#include "core/base/text.h"
#include "core/image_io/image_io.h"
#include "core/rig/albedo_scale.h"
#include "core/solve/solve.h"
#include "material/assets/build.h"
#include "material/read/file_meaning.h"
#include "material/run/maps.h"
#include "material/run/session_sets.h"
#include "solve/session/solved.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using enum Parameter;

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
      {kSpecular, "specular", "specular.exr", {"f0"}, 1 / kF0OfSpecular},
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
  const Result<Product> found = find_solve(absolute_folder(set.folder).parent_path().parent_path(), solve);
  if (!found) return false;
  const Result<Json> document = read_json(found->folder / kSolveProduct.document, kSolveProduct.schema, 1);
  return document && document->value("albedo_scale", "") == name_of(AlbedoScale::kRelative);
}

Json provenance_of(const MapSet& set, const fs::path& scan) {
  Json facts = Json::object();
  for (const char* key : {"id", "solve", "rectified", "level"}) {
    if (set.document.contains(key) && set.document[key].is_string())
      facts[key == std::string("id") ? "maps" : key] = set.document[key];
  }
  if (const Result<Session> session = solve::read_solved(scan)) {
    facts["session"] = solve::is_lone_solve(*session) ? session->fabric : scan.filename().string();
  }
  if (!set.is_size_known) facts["size_known"] = false;
  return facts;
}

// Masks follow the height, so a set that has one is preferred.
Result<fs::path> folder_of_maps(const fs::path& scan) {
  if (is_there(scan / kMapsProduct.document) || is_there(scan / kMaterialProduct.document)) return scan;
  const Result<Session> session = solve::read_solved(scan);
  const solve::SessionSolves solves =
      session ? solve::solves_of(*session) : solve::SessionSolves{.session = scan, .all = {}};
  const std::vector<SessionSet> sets = sets_of(solves);
  if (const SessionSet* set = set_to_use(solves, sets, {"height"})) return set->product.folder;
  return Error{ErrorKind::kNoInput, "there are no maps to take from", scan.string(),
               "it is no session with maps, no set of maps and no built material",
               "make them first with weft maps " + scan.string()};
}

// What its session says of its solve today; a set that lies elsewhere says it itself.
Result<void> find_solve_of(MapSet& set, bool draft) {
  bool is_draft = flag_at(set.document, "draft");
  std::string remedy = "make better ones with weft maps";
  const Result<Session> session = solve::read_solved(absolute_folder(set.folder).parent_path().parent_path());
  if (const std::string id = text_at(set.document, "solve"); session && !id.empty()) {
    const solve::SessionSolves solves = solve::solves_of(*session);
    const solve::ChoosableSolve* const solve = solves.find(id);
    set.stale = why_stale(solves, id);
    if (solve != nullptr) is_draft = solve->is_preview();
    if (solve != nullptr) set.provenance["level"] = solve->level;
    remedy = how_to_make_better(solves);
  }
  if (!is_draft) return {};
  set.provenance["draft"] = true;
  if (draft) return {};
  return unusable(ErrorKind::kUsage, set.folder.string(),
                  "its maps are of a preview, which has half the size and no masks",
                  remedy + "; draft = true beside scan (weft material new --draft) takes the draft");
}

// One number or three, as a set says them in place of a file.
std::optional<std::vector<double>> same_everywhere(const MapSet& set, const ScanMap& map) {
  const auto parameters = set.document.find("parameters");
  const char* name = facts_of(map.parameter).name;
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
  const double each = mm == info.attributes.end() ? 0 : as_number(mm->second).value_or(0);
  const PixelPitch pitch = each > 0 ? PixelPitch{each, each} : info.pitch_mm;
  if (!(pitch[0] > 0 && pitch[0] < 1e3 && pitch[1] > 0 && pitch[1] < 1e3)) return {};
  return std::array<double, 2>{pitch[0] * info.size.width, pitch[1] * info.size.height};
}

// What of the catalogue of exports a parameter can be read from, and its factor.
struct ExportedParameter {
  Parameter parameter;
  std::vector<std::string> channels;
  double scale = 1;
};

const std::vector<ExportedParameter>& exported_parameters() {
  static const std::vector<ExportedParameter> all = {
      {kAlbedo, {"albedo.r", "albedo.g", "albedo.b"}},
      {kNormal, {"normal.x", "normal.y", "normal.z"}},
      {kNormal, {"normal.x", "normal.y"}},
      {kHeight, {"height"}},
      {kOcclusion, {"occlusion"}},
      {kOpacity, {"opacity"}},
      {kCavity, {"cavity"}},
      {kRoughness, {"roughness"}},
      {kRoughness, {"roughness.least"}},
      {kSpecular, {"specular"}},
      {kSpecular, {"f0"}, 1 / kF0OfSpecular},
      {kSpecularTint, {"specular_tint.r", "specular_tint.g", "specular_tint.b"}},
      {kMetallic, {"metallic"}},
      {kSheen, {"sheen.r", "sheen.g", "sheen.b"}},
      {kSheenRoughness, {"sheen_roughness"}},
      {kCloth, {"cloth"}},
  };
  return all;
}

// Values of the samples 0 and 1 as scale and offset, where they are others.
void take_range(const ChannelMeaning& channel, double factor, MapFile& map) {
  const exchange::ChannelRange range = channel.range.value_or(exchange::ChannelRange{});
  if (range.least == 0 && range.most == 1 && factor == 1) return;
  map.scale = factor * (range.most - range.least);
  map.offset = factor * range.least;
}

void take_roughness(exchange::RoughnessConvention convention, MapFile& map) {
  using enum exchange::RoughnessConvention;
  if (convention == kSmoothness) {
    map.scale = -1;
    map.offset = 1;
  } else {
    map.unit = convention == kRoot
                   ? "roughness"
                   : exchange::kRoughnessConventionNames[static_cast<std::size_t>(convention)];
  }
}

// Takes what an export.json lists of a file.
Result<void> take_listing(Parameter parameter, const FileMeaning& meaning, const Json& value,
                          const std::string& where, MapFile& map) {
  const std::string said = value.value("channel", "");
  for (const ExportedParameter& row : exported_parameters()) {
    const auto places = row.parameter == parameter ? meaning.find(row.channels) : std::nullopt;
    if (!places || (!said.empty() && said != meaning.info.channels[places->front()])) continue;
    for (const std::size_t place : *places) map.channels.push_back(meaning.info.channels[place]);
    const ChannelMeaning& first = meaning.channels[places->front()];
    map.is_srgb = first.is_srgb;
    take_range(first, row.scale, map);
    if (parameter == kRoughness) take_roughness(meaning.roughness, map);
    map.y_is_down = meaning.direction == exchange::NormalDirection::kDirectX;
    return {};
  }
  if (!said.empty()) return {};
  std::string names;
  for (const ChannelMeaning& channel : meaning.channels)
    names += (names.empty() ? "" : ", ") + (channel.is.empty() ? "nothing known" : channel.is);
  return unusable(ErrorKind::kBadData, where,
                  fmt::format("by its export.json {} holds {}, and no {}", map.file.filename().string(),
                              names, facts_of(parameter).name),
                  "name another file of the export, or say channel");
}

// Takes what any file tells of itself.
Result<void> take_tags(Parameter parameter, const FileMeaning& meaning, const Json& value,
                       const std::string& where, MapFile& map) {
  const ImageFileInfo& info = meaning.info;
  const auto says = [&](const char* key) { return value.contains(key); };
  if (const auto places = meaning.find({"normal.x", "normal.y", "normal.z"});
      parameter == kNormal && places) {
    for (const std::size_t place : *places) map.channels.push_back(info.channels[place]);
  }
  const bool is_color = facts_of(parameter).kind == ParameterKind::kColour;
  if (is_color && info.color == ColorSpace::kOther && !says("transfer")) {
    return unusable(
        ErrorKind::kBadData, where,
        fmt::format("{} says that its colours went through a curve that is neither that of sRGB nor none",
                    map.file.filename().string()),
        "export it in sRGB or linear, or say transfer");
  }
  const bool is_integer = info.type == SampleType::kUint8 || info.type == SampleType::kUint16;
  if (parameter == kHeight && is_integer && map.unit.empty() && !says("scale") && !says("unit")) {
    return unusable(
        ErrorKind::kBadData, where,
        fmt::format("{} holds integers, and nothing says how many millimetres its black and white are",
                    map.file.filename().string()),
        "say scale, the millimetres between them, and offset, those of black");
  }
  return {};
}

void take_words(const Json& value, MapFile& map) {
  if (value.contains("scale") || value.contains("offset")) map.scale = map.offset = std::nullopt;
  if (value.contains("scale")) map.scale = value["scale"].get<double>();
  if (value.contains("offset")) map.offset = value["offset"].get<double>();
  if (value.contains("channel")) map.channels = {value["channel"].get<std::string>()};
  if (value.contains("transfer")) map.is_srgb = value["transfer"] == "srgb";
  if (value.contains("unit")) map.unit = value["unit"].get<std::string>();
  if (value.contains("y")) map.y_is_down = value["y"] == "down";
}

Result<MapFile> map_of_file(std::optional<Parameter> parameter, const Json& value, const std::string& where) {
  MapFile map = {.file = value["map"].get<std::string>()};
  const Result<FileMeaning> meaning = meaning_of(map.file);
  if (!meaning) {
    Error error = meaning.error();
    error.where = where + ": " + error.where;
    return error;
  }
  const ImageFileInfo& info = meaning->info;
  map.size = info.size;
  map.size_mm = size_of(info);
  const auto source = info.attributes.find("weft.source");
  if (source != info.attributes.end()) map.source = source->second;
  const auto unit = info.attributes.find("weft.unit");
  if (unit != info.attributes.end()) map.unit = unit->second;
  map.provenance = {{"file", map.file.filename().string()}};
  if (parameter) {
    const Result<void> taken = meaning->is_listed ? take_listing(*parameter, *meaning, value, where, map)
                                                  : take_tags(*parameter, *meaning, value, where, map);
    if (!taken) return taken.error();
  } else if (meaning->is_listed && meaning->channels.size() == 1) {
    take_range(meaning->channels.front(), 1, map);
  }
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
  found.is_size_known = set.is_size_known;
  found.is_tile = set.is_tile;
  found.is_of_scan = true;
  found.stale = set.stale;
  found.provenance = set.provenance;
  found.provenance["map"] = map.name;
  return found;
}

Result<MapFile> map_of_scan(std::optional<Parameter> parameter, const Json& value, const std::string& where) {
  const Result<MapSet> set = open_map_set(value["scan"].get<std::string>(), value.value("draft", false));
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
    const auto &facts = facts_of(*parameter), &others = facts_of(other->parameter);
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
  const bool is_said = value.contains("scale") || value.contains("offset");
  if (map.same && is_said && parameter != kNormal) {
    for (double& each : *map.same) each = map.scale.value_or(1) * each + map.offset.value_or(0);
  }
  if (own && is_said) map.scale = *own * map.scale.value_or(1);
  return map;
}

}  // namespace

Result<MapSet> open_map_set(const fs::path& scan, bool draft) {
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
  set.is_size_known = document->value("size_known", true);
  if (mm > 0) set.size_mm = {{mm * set.size.width, mm * set.size.height}};
  set.document = std::move(*document);
  if (is_material && set.document.contains("size_mm"))
    set.size_mm = {{set.document["size_mm"][0].get<double>(), set.document["size_mm"][1].get<double>()}};
  set.is_albedo_relative = has_relative_albedo(set);
  set.provenance = provenance_of(set, scan);
  if (!is_material) {
    if (Result<void> ok = find_solve_of(set, draft); !ok) return std::move(ok).error();
  }
  return set;
}

Json source_of(const MapSet& set) {
  if (!set.provenance.contains("solve")) return nullptr;
  Json source = set.provenance;
  source.erase("rectified");
  if (!set.stale.empty()) source["stale"] = set.stale;
  return source;
}

Result<MapFile> find_map(Parameter parameter, const Json& value, const std::string& where) {
  Result<MapFile> map =
      value.contains("scan") ? map_of_scan(parameter, value, where) : map_of_file(parameter, value, where);
  if (!map) return map;
  const ParameterFacts& facts = facts_of(parameter);
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
  return value.contains("scan") ? map_of_scan({}, value, where) : map_of_file({}, value, where);
}

Result<ParameterField> read_built(const MapSet& built, Parameter parameter) {
  const auto map =
      std::ranges::find_if(scan_maps(), [&](const ScanMap& each) { return each.parameter == parameter; });
  const MapFile file = file_in(built, *map);
  if (file.file.empty() && !file.same) {
    const ParameterFacts& facts = facts_of(parameter);
    return ParameterField::same(facts.otherwise, numbers_of(facts.kind));
  }
  return read_field(parameter, file, built.folder.string());
}

Result<void> expand_scan(MaterialFile& file) {
  const auto scan = file.top.find("scan");
  if (scan == file.top.end()) return {};
  const std::string folder = scan->second.value.get<std::string>();
  const auto asks = file.top.find("draft");
  const bool is_draft = asks != file.top.end() && asks->second.value.get<bool>();
  const Result<MapSet> set = open_map_set(folder, is_draft);
  if (!set) {
    Error error = set.error();
    error.where = file.place.name + ": scan: " + error.where;
    return error;
  }
  const std::string from = scan->second.from;
  for (const ScanMap& map : scan_maps()) {
    const char* name = facts_of(map.parameter).name;
    if (!map.is_own || file.surface.contains(name) || !has_map(*set, map)) continue;
    const MapFile found = file_in(*set, map);
    if (found.same && found.source == "assumed" && !is_there(set->folder / kMaterialProduct.document))
      continue;
    Json value = {{"map", map.name}, {"scan", folder}};
    if (is_draft) value["draft"] = true;
    file.surface[name] = {std::move(value), from};
  }
  // An assumed size goes with the maps, so that one that is said stands for it.
  if (!file.top.contains("size_mm") && set->size_mm && set->is_size_known)
    file.top["size_mm"] = {Json{(*set->size_mm)[0], (*set->size_mm)[1]}, from};
  if (!file.top.contains("is_tile")) file.top["is_tile"] = {Json(set->is_tile), from};
  file.top.erase("scan");
  return {};
}

}  // namespace weft::material
