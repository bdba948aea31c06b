// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/map_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/files.h"
#include "core/base/product.h"
#include "core/base/text.h"
#include "core/image_io/image_io.h"
#include "core/rig/albedo_scale.h"
#include "core/solve/solve.h"
#include "exchange/document.h"
#include "material/run/maps.h"
#include "material/run/session_sets.h"
#include "solve/session/solved.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnusable = "the maps cannot be exported";

struct FolderKind {
  const char* document;
  const char* schema;
  const char* kind;
};
constexpr std::array<FolderKind, 3> kFolderKinds = {{{"maps.json", "weft.maps", "maps"},
                                                     {"material.json", "weft.material-build", "material"},
                                                     {"solve.json", "weft.solve", "solve"}}};

Error unfit_folder(const std::string& where, std::string why) {
  return {ErrorKind::kBadData, kUnusable, where, std::move(why), "make the maps again"};
}

bool stays_inside(const std::string& file) {
  const fs::path path(file);
  return !file.empty() && path.is_relative() &&
         std::ranges::none_of(path, [](const fs::path& part) { return part == ".."; });
}

Result<fs::path> set_of_session(const MapFolderWish& wish) {
  if (!wish.maps_id.empty()) {
    const Result<Product> found = find_product(material::kMapsProduct, wish.input / "maps", wish.maps_id);
    if (!found) return found.error();
    return found->folder;
  }
  const Result<Session> session = solve::read_solved(wish.input);
  if (!session) return session.error();
  const solve::SessionSolves solves = solve::solves_of(*session);
  const std::vector<material::SessionSet> sets = material::sets_of(solves);
  if (const material::SessionSet* set = material::set_to_use(solves, sets, wish.wanted))
    return set->product.folder;
  if (solves.is_lone) return wish.input;
  return Error{ErrorKind::kNoInput, fmt::format("there is no complete {}", material::kMapsProduct.noun),
               (wish.input / "maps").string(), "no folder there holds a maps.json that can be read",
               fmt::format("make it first with weft maps {}", wish.input.string())};
}

Result<material::MapFacts> map_from_json(const Json& entry, const std::string& where) {
  JsonFields fields(entry, where);
  material::MapFacts map = {.name = fields.text("name"),
                            .file = fields.text_or("file", ""),
                            .source = material::map_source_named(fields.text_or("source", "")),
                            .constant = fields.optional_number("constant"),
                            .document = entry};
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (map.file.empty() != map.constant.has_value())
    return unfit_folder(where, "a map has a file or is one number, and this one is not");
  if (map.constant) return map;
  if (!stays_inside(map.file)) return unfit_folder(where + ": file", "it leaves the folder");
  map.least = fields.optional_number("least").value_or(0);
  map.most = fields.optional_number("most").value_or(0);
  return map;
}

// The files of a surface, which documents of sets and solves do not list.
void add_surface(MapFolder& folder) {
  for (const char* name : {"normal", "albedo", "roughness", "specular"}) {
    const std::string file = fmt::format("{}.exr", name);
    if (folder.map(name) == nullptr && is_there(folder.folder / file))
      folder.maps.push_back({.name = name, .file = file, .source = material::MapSource::kMeasured});
  }
}

// Parameters of a built material that are no maps: a number or three, or {"value", "source"} of them.
Result<void> add_parameters(const Json& parameters, const std::string& where,
                            std::vector<material::MapFacts>& maps) {
  for (const auto& [name, written] : parameters.items()) {
    const bool is_object = written.is_object() && written.contains("value");
    const Json& value = is_object ? written["value"] : written;
    std::vector<double> numbers;
    for (const Json& each : value.is_array() ? value : Json::array({value})) {
      if (each.is_number()) numbers.push_back(each.get<double>());
    }
    if (numbers.empty()) continue;
    if (!std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); }))
      return unfit_folder(where + ": " + name, "it is no finite number");
    if (std::ranges::any_of(maps, [&name = name](const material::MapFacts& map) { return map.name == name; }))
      continue;
    maps.push_back({.name = name,
                    .source = material::map_source_named(is_object ? written.value("source", "") : ""),
                    .constant = numbers.front(),
                    .document = {{"numbers", numbers}}});
  }
  return {};
}

// A set lies in SESSION/maps/ID, a solve in SESSION/solve/ID; one of photographs stands for their session.
void find_session(MapFolder& folder) {
  const fs::path own = absolute_folder(folder.folder);
  for (const fs::path& session : {own.parent_path().parent_path(), own}) {
    Result<Session> read = solve::read_solved(session);
    if (read) folder.session = std::move(*read);
    if (read) return;
  }
}

// Which solve it comes from, how good that is, and what speaks against it today.
Result<void> find_source(MapFolder& folder, bool draft) {
  const Json& document = folder.document;
  const bool is_solve = folder.kind == "solve";
  folder.level = material::text_at(document, is_solve ? "method" : "level");
  folder.is_draft = is_solve ? folder.level == solve::kLevels.front() : material::flag_at(document, "draft");
  if (folder.session && folder.kind != "material") {
    const solve::SessionSolves solves = solve::solves_of(*folder.session);
    const std::string id = is_solve ? folder.id : material::text_at(document, "solve");
    const solve::ChoosableSolve* const found = solves.find(id);
    folder.stale = why_stale(solves, id);
    if (found != nullptr) {
      folder.level = found->level;
      folder.is_draft = found->is_preview();
    }
  }
  if (!folder.is_draft || draft) return {};
  std::string remedy = "build it of better maps: weft maps SESSION, then leave draft out of its file";
  if (folder.session) remedy = material::how_to_make_better(solve::solves_of(*folder.session));
  return Error{ErrorKind::kUsage, kUnusable, folder.folder.string(),
               "they are of a preview, which has half the size and no masks",
               remedy + "; --draft exports the draft"};
}

std::string scale_of(const MapFolder& folder) {
  constexpr const char* kKey = "albedo_scale";
  if (folder.document.contains(kKey) && folder.document[kKey].is_string())
    return folder.document[kKey].get<std::string>();
  if (!folder.session || !folder.document.contains("solve") || !folder.document["solve"].is_string())
    return "unknown";
  const Result<Product> solve =
      find_solve(folder.session->folder, folder.document["solve"].get<std::string>());
  if (!solve) return "unknown";
  const Result<Json> document = read_json(solve->folder / kSolveProduct.document, kSolveProduct.schema, 1);
  return document ? document->value(kKey, "unknown") : "unknown";
}

std::string title_of(const MapFolder& folder) {
  std::string name = folder.document.value("name", "");
  if (name.empty() && folder.session) name = folder.session->fabric;
  if (name.empty() && folder.session) name = folder.session->folder.stem().string();
  if (name.empty()) name = absolute_folder(folder.folder).filename().string();
  return name;
}

Result<MapFolder> read_folder(const fs::path& path, const FolderKind& kind) {
  Result<Json> document = read_json(path / kind.document, kind.schema, 1);
  if (!document) return std::move(document).error();
  MapFolder folder;
  folder.folder = path;
  folder.kind = kind.kind;
  folder.document_file = kind.document;
  const std::string where = (path / kind.document).string();
  JsonFields fields(*document, where);
  folder.id = fields.text("id");
  folder.size = {fields.integer("width"), fields.integer("height")};
  if (folder.size.width < 1 || folder.size.height < 1)
    fields.reject("width", "must be above 0, and height too");
  folder.mm_per_pixel = fields.optional_number("mm_per_pixel");
  if (folder.mm_per_pixel && !(*folder.mm_per_pixel > 0)) fields.reject("mm_per_pixel", "must be above 0");
  folder.is_size_known = !document->contains("size_known") || (*document)["size_known"] != false;
  folder.is_tile = document->contains("is_tile") && (*document)["is_tile"] == true;
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (folder.kind != "solve") {
    const Json& maps = fields.list("maps");
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    for (std::size_t i = 0; i < maps.size(); ++i) {
      Result<material::MapFacts> map = map_from_json(maps[i], fmt::format("{}: maps {}", where, i + 1));
      if (!map) return std::move(map).error();
      folder.maps.push_back(std::move(*map));
    }
  }
  if (document->contains("parameters") && (*document)["parameters"].is_object()) {
    if (Result<void> ok = add_parameters((*document)["parameters"], where + ": parameters", folder.maps); !ok)
      return std::move(ok).error();
  }
  if (folder.kind != "material") add_surface(folder);
  folder.document = std::move(*document);
  find_session(folder);
  folder.albedo_scale = scale_of(folder);
  folder.title = title_of(folder);
  folder.name = file_name_of(folder.title, "cloth");
  if (!is_plain_text(folder.title)) folder.title = folder.name;
  return folder;
}

// A number of the roughness map: alpha where it is said, else the square of the root.
std::optional<double> alpha_constant(const material::MapFacts& map, const char* key) {
  if (map.document.contains(key) && map.document[key].is_number()) return map.document[key].get<double>();
  if (map.document.contains("alpha") && map.document["alpha"].is_number())
    return map.document["alpha"].get<double>();
  return map.constant ? std::optional(*map.constant * *map.constant) : std::nullopt;
}

std::optional<double> number_of(const MapFolder& folder, const char* name) {
  const material::MapFacts* map = folder.map(name);
  return map == nullptr ? std::nullopt : map->constant;
}

// Two alphas whose smaller one is `alpha`, by the strength of KHR_materials_anisotropy. The highlight of a
// built material is stretched along anisotropy_deg, so its larger alpha stands along.
PlaneOrigin roughness_constant(const MapFolder& folder, const material::MapFacts& map, MapPlane plane) {
  const std::optional<double> alpha = alpha_constant(map, "alpha");
  if (plane == MapPlane::kAlpha) return {.constant = alpha};
  const double strength = number_of(folder, "anisotropy").value_or(0);
  if (plane == MapPlane::kYarnDeg) return {.constant = number_of(folder, "anisotropy_deg").value_or(0)};
  const std::optional<double> along = alpha_constant(map, "alpha_along");
  if (strength == 0 || !alpha) return {.constant = along};
  return {.constant = *alpha + (1 - *alpha) * strength * strength};
}

}  // namespace

const material::MapFacts* MapFolder::map(const std::string& wanted) const {
  const auto found = std::ranges::find(maps, wanted, &material::MapFacts::name);
  return found == maps.end() ? nullptr : &*found;
}

Result<MapFolder> open_map_folder(const MapFolderWish& wish) {
  const fs::path& input = wish.input;
  fs::path folder = input;
  const Result<Session> session = solve::read_solved(input);
  if (session || is_there(input / "session.json")) {
    const Result<fs::path> set = set_of_session(wish);
    if (!set) return set.error();
    folder = *set;
  } else if (!wish.maps_id.empty()) {
    return Error{ErrorKind::kUsage, kUnusable, "--maps",
                 "it chooses among the sets of a session, and " + input.string() + " is none",
                 "name the session, or leave --maps out"};
  }
  for (const FolderKind& kind : kFolderKinds) {
    if (!is_there(folder / kind.document)) continue;
    Result<MapFolder> read = read_folder(folder, kind);
    if (!read) return read;
    if (Result<void> ok = find_source(*read, wish.is_draft); !ok) return std::move(ok).error();
    return read;
  }
  if (!session && session.error().kind == ErrorKind::kUsage) return session.error();
  return Error{ErrorKind::kNoInput, kUnusable, input.string(),
               "it is no session, no set of maps, no built material and no solve",
               "name a folder with session.json, maps.json, material.json or solve.json"};
}

std::vector<std::string> source_of(const MapFolder& folder) {
  std::vector<std::string> lines;
  if (folder.kind == "material") {
    for (const Json& scan : folder.document.value("scans", Json::array())) {
      for (const std::string& line : material::source_lines(material::source_in(scan)))
        lines.push_back(fmt::format("{}: {}", material::text_at(scan, "session"), line));
    }
    return lines;
  }
  return material::source_lines(
      {folder.kind == "solve" ? folder.id : material::text_at(folder.document, "solve"), folder.level,
       folder.is_draft, folder.stale});
}

Result<Json> provenance_of(const MapFolder& folder) {
  Json json = {{folder.kind, folder.id}};
  const Result<std::string> digest = sha256_of_file(folder.folder / folder.document_file);
  if (!digest) return digest.error();
  json[folder.kind + "_sha256"] = *digest;
  for (const char* key : {"solve", "rectified", "scans", "inputs"}) {
    if (folder.kind != key && folder.document.contains(key)) json[key] = folder.document[key];
  }
  if (!folder.level.empty()) json["level"] = folder.level;
  json["draft"] = folder.is_draft;
  if (!folder.stale.empty()) json["stale"] = folder.stale;
  if (!folder.session) return json;
  const Session& session = *folder.session;
  if (!solve::is_lone_solve(session)) {
    const Result<std::string> session_digest = sha256_of_file(session.folder / "session.json");
    if (!session_digest) return session_digest.error();
    json["session"] = {{"name", session.folder.filename().string()},
                       {"fabric", session.fabric},
                       {"sha256", *session_digest}};
    if (session.is_of_rig()) json["calibration"] = session.calibration_id;
  }
  json["raws"] = Json::array();
  for (const Shot& shot : session.shots)
    json["raws"].push_back({{"file", shot.file}, {"sha256", shot.sha256}});
  return json;
}

PlaneOrigin origin_of(const MapFolder& folder, MapPlane plane) {
  const PlaneKind& kind = kind_of(plane);
  const material::MapFacts* map = folder.map(kind.map);
  if (map == nullptr && std::string(kind.map) == "specular") map = folder.map("f0");
  if (map == nullptr && std::string(kind.map) == "height") map = folder.map("height_mm");
  if (map == nullptr) return {};
  if (map->file.empty() && map->document.contains("numbers") && map->document["numbers"].size() == 3) {
    const std::size_t part = std::string_view("RGB").find(kind.channel);
    return {.constant = map->document["numbers"][std::min<std::size_t>(part, 2)].get<double>()};
  }
  if (map->file.empty()) {
    return std::string(kind.map) == "roughness" ? roughness_constant(folder, *map, plane)
                                                : PlaneOrigin{.constant = map->constant};
  }
  std::vector<std::string> channels = {kind.channel};
  if (plane == MapPlane::kAlphaAlong) channels.emplace_back("alpha");
  return {.file = map->file, .channels = std::move(channels)};
}

}  // namespace weft::exchange
