// SPDX-License-Identifier: Apache-2.0
#include "material/assets/material_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.h"
#include "core/toml/field_toml.h"
#include "material/assets/material_file.h"
#include "material/filtering/joined_gloss.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using enum MaterialHolds;

const std::vector<MaterialKey>& map_keys() {
  static const std::vector<MaterialKey> keys = {
      {.name = "map", .holds = kText},
      {.name = "scan", .holds = kFolder},
      {.name = "draft", .holds = kFlag},
      {.name = "unit", .holds = kText},
      {.name = "scale", .holds = kNumber, .least = -1e6, .most = 1e6},
      {.name = "offset", .holds = kNumber, .least = -1e6, .most = 1e6},
      {.name = "channel", .holds = kText},
      {.name = "transfer", .holds = kWord, .words = {"linear", "srgb"}},
      {.name = "y", .holds = kWord, .words = {"up", "down"}},
      {.name = "levels", .holds = kNumbers, .least = -1e6, .most = 1e6, .count = 2}};
  return keys;
}

const std::vector<MaterialKey>& relief_mask_keys() {
  static const std::vector<MaterialKey> keys = {
      {.name = "from", .holds = kWord, .words = {"height"}},
      {.name = "kind", .holds = kWord, .words = {"cavity", "level"}},
      {.name = "radius_mm", .holds = kNumber, .least = 1e-4, .most = 1000},
      {.name = "range_mm", .holds = kNumber, .least = 0, .most = 1000},
      {.name = "at_mm", .holds = kNumber, .least = -1000, .most = 1000},
      {.name = "soft_mm", .holds = kNumber, .least = 0, .most = 1000},
      {.name = "levels", .holds = kNumbers, .least = -1e6, .most = 1e6, .count = 2}};
  return keys;
}

bool is_within(const Json& value, double least, double most) {
  return value.is_number() && std::isfinite(value.get<double>()) && value.get<double>() >= least &&
         value.get<double>() <= most;
}

bool is_whole(const Json& value) {
  return value.is_number() && std::floor(value.get<double>()) == value.get<double>();
}

std::string range_words(double least, double most, const char* unit) {
  const std::string unit_words = unit == nullptr || *unit == 0 ? "" : fmt::format(" ({})", unit);
  return fmt::format("{:g} to {:g}{}", least, most, unit_words);
}

std::string absolute_name(const std::string& written, const fs::path& folder) {
  return (folder.empty() ? fs::path(written) : folder / written).lexically_normal().string();
}

// Each key of an object by its table.
Result<Json> object_of_keys(const Json& value, std::span<const MaterialKey> keys, const WrittenIn& in) {
  Json object = Json::object();
  for (const auto& [name, each] : value.items()) {
    const Result<const MaterialKey*> key = known_key(name, keys, in);
    if (!key) return key.error();
    Result<Json> read = value_of_key(**key, each, in);
    if (!read) return read;
    object[name] = std::move(*read);
  }
  return object;
}

// A map of a file or of a scan; the file's name becomes absolute.
Result<Json> map_of(const Json& value, const std::string& key, const WrittenIn& in) {
  const WrittenIn inner = {in.where + " " + key, in.folder};
  Result<Json> map = object_of_keys(value, map_keys(), inner);
  if (!map) return map;
  if (!map->contains("map"))
    return unfit_material(
        in, key, "a map is written { map = \"FILE\" }, or { scan = \"NAME.weft\", map = \"normal\" }");
  if (in.folder.empty()) return unfit_material(in, key, "what weft brings along has no maps");
  if (!map->contains("scan")) (*map)["map"] = absolute_name((*map)["map"].get<std::string>(), in.folder);
  return map;
}

Result<Json> mask_of(const Json& value, const WrittenIn& in) {
  if (value.is_number()) {
    if (!is_within(value, 0, 1)) return unfit_material(in, "mask", "a number must be 0 to 1");
    return Json{{"value", value.get<double>()}};
  }
  if (!value.is_object())
    return unfit_material(in, "mask",
                          "it must be a number, a map or { from = \"height\", kind = \"cavity\" }");
  if (!value.contains("from")) return map_of(value, "mask", in);
  Result<Json> mask = object_of_keys(value, relief_mask_keys(), {in.where + " mask", in.folder});
  if (!mask) return mask;
  if (!mask->contains("kind")) (*mask)["kind"] = "cavity";
  const bool is_level = (*mask)["kind"] == "level";
  if (is_level && !mask->contains("at_mm")) return unfit_material(in, "mask", "a level needs at_mm");
  for (const char* name : {"at_mm", "soft_mm"}) {
    if (!is_level && mask->contains(name))
      return unfit_material(in, "mask", fmt::format("{} belongs to kind = \"level\"", name));
  }
  for (const char* name : {"radius_mm", "range_mm"}) {
    if (is_level && mask->contains(name))
      return unfit_material(in, "mask", fmt::format("{} belongs to kind = \"cavity\"", name));
  }
  return mask;
}

Result<Json> numbers_of_key(const MaterialKey& key, const Json& value, const WrittenIn& in) {
  const bool fits = value.is_array() && value.size() == static_cast<std::size_t>(key.count) &&
                    std::ranges::all_of(value, [&](const Json& n) {
                      return is_within(n, key.least, key.most) && (key.holds != kWholes || is_whole(n));
                    });
  if (!fits) {
    return unfit_material(
        in, key.name,
        fmt::format("it must be {} {}numbers of {}", key.count, key.holds == kWholes ? "whole " : "",
                    range_words(key.least, key.most, nullptr)));
  }
  if (key.holds == kWholes) return Json(value.get<std::vector<int>>());
  return Json(value.get<std::vector<double>>());
}

Result<Json> parameters_of(const MaterialKey& key, const Json& value, const WrittenIn& in) {
  if (!value.is_array() || value.empty())
    return unfit_material(in, key.name, "it must be a list of parameters");
  for (const Json& each : value) {
    if (!each.is_string()) return unfit_material(in, key.name, "it must be a list of parameters");
    const std::string name = each.get<std::string>();
    if (parameter_named(name)) continue;
    const auto nearest = std::ranges::min_element(
        parameters(), {}, [&](const ParameterFacts& f) { return edit_distance(name, f.name); });
    return unfit_material(in, key.name,
                          fmt::format("there is no parameter {}; the nearest is {}", name, nearest->name));
  }
  return value;
}

// A unit that a map of the parameter may have; roughness is converted, and a scale says how others are.
bool is_unit_of(const ParameterFacts& facts, const Json& map) {
  if (!map.contains("unit") || map.contains("scale")) return true;
  const std::string unit = map["unit"].get<std::string>();
  if (unit == facts.unit) return true;
  const bool is_lobe =
      facts.parameter == Parameter::kRoughness || facts.parameter == Parameter::kSheenRoughness;
  return is_lobe && gloss_scale_named(unit).has_value();
}

}  // namespace

std::span<const MaterialKey> top_keys() {
  static const std::vector<MaterialKey> keys = {
      {.name = "schema", .holds = kText},
      {.name = "inherits", .holds = kText},
      {.name = "name", .holds = kText},
      {.name = "notes", .holds = kText},
      {.name = "size_mm", .holds = kNumbers, .least = 1e-3, .most = 1e5, .count = 2},
      {.name = "is_tile", .holds = kFlag},
      {.name = "pixels", .holds = kWholes, .least = 1, .most = 32768, .count = 2},
      {.name = "scan", .holds = kFolder},
      {.name = "draft", .holds = kFlag},
      {.name = "surface", .holds = kTable},
      {.name = "over", .holds = kTable},
      {.name = "layer", .holds = kTable},
      {.name = "runtime", .holds = kTable},
      {.name = "unset", .holds = kTexts}};
  return keys;
}

std::span<const MaterialKey> layer_keys() {
  static const std::vector<MaterialKey> keys = {
      {.name = "name", .holds = kText},
      {.name = "material", .holds = kFile},
      {.name = "mask", .holds = kMask},
      {.name = "alpha", .holds = kNumber, .least = 0, .most = 1},
      {.name = "only", .holds = kNames},
      {.name = "blend", .holds = kWord, .words = {"replace", "detail"}},
      {.name = "normals", .holds = kWord, .words = {"add-slopes", "whiteout", "rnm", "blend-xy"}},
      {.name = "tile_mm", .holds = kNumbers, .least = 1e-3, .most = 1e5, .count = 2},
      {.name = "offset_mm", .holds = kNumbers, .least = -1e5, .most = 1e5, .count = 2},
      {.name = "turn_deg", .holds = kNumber, .least = -360, .most = 360},
      {.name = "tint", .holds = kColour, .least = 0, .most = 4, .count = 3},
      {.name = "remove", .holds = kFlag},
      {.name = "after", .holds = kText}};
  return keys;
}

std::span<const MaterialKey> runtime_keys() {
  static const std::vector<MaterialKey> keys = {{.name = "weights", .holds = kMap},
                                                {.name = "layer", .holds = kTable}};
  return keys;
}

std::span<const MaterialKey> runtime_layer_keys() {
  static const std::vector<MaterialKey> keys = {{.name = "name", .holds = kText},
                                                {.name = "material", .holds = kFile},
                                                {.name = "remove", .holds = kFlag},
                                                {.name = "after", .holds = kText}};
  return keys;
}

Error unfit_material(const WrittenIn& in, const std::string& key, std::string why) {
  return {ErrorKind::kBadData, "the material cannot be used",
          fmt::format("{}{}{}", in.where, in.where.ends_with(']') ? " " : ": ", key), std::move(why),
          "correct it there; docs/materials.md has every key"};
}

Result<const MaterialKey*> known_key(const std::string& name, std::span<const MaterialKey> known,
                                     const WrittenIn& in) {
  const auto found = std::ranges::find_if(known, [&](const MaterialKey& key) { return name == key.name; });
  if (found != known.end()) return &*found;
  std::vector<std::string> names;
  for (const MaterialKey& key : known) names.emplace_back(key.name);
  return unfit_material(in, name, no_such_key(names, name));
}

Result<Json> value_of_key(const MaterialKey& key, const Json& value, const WrittenIn& in) {
  const auto wrong = [&](std::string why) -> Result<Json> {
    return unfit_material(in, key.name, std::move(why));
  };
  switch (key.holds) {
    case kText:
      return value.is_string() ? Result<Json>(value) : wrong("it must be a text");
    case kFile:
      if (!value.is_string())
        return wrong("it must be the name of a material; two are composed by a layer each");
      if (value.get<std::string>().starts_with(kLibraryPrefix)) return value;
      if (in.folder.empty()) return wrong("what weft brings along names only library: materials");
      return Json(absolute_name(value.get<std::string>(), in.folder));
    case kFolder:
      if (!value.is_string()) return wrong("it must be the folder of a scan");
      if (in.folder.empty()) return wrong("what weft brings along has no scans");
      return Json(absolute_name(value.get<std::string>(), in.folder));
    case kFlag:
      return value.is_boolean() ? Result<Json>(value) : wrong("it must be true or false");
    case kNumber:
      if (!is_within(value, key.least, key.most))
        return wrong("it must be " + range_words(key.least, key.most, nullptr));
      return Json(value.get<double>());
    case kNumbers:
    case kWholes:
    case kColour:
      return numbers_of_key(key, value, in);
    case kWord: {
      const bool is_word =
          value.is_string() && std::ranges::find(key.words, value.get<std::string>()) != key.words.end();
      return is_word ? Result<Json>(value)
                     : wrong(fmt::format("it must be one of {}", fmt::join(key.words, ", ")));
    }
    case kNames:
      return parameters_of(key, value, in);
    case kMask:
      return mask_of(value, in);
    case kMap:
      if (value == "vertex-color") return value;
      if (!value.is_object()) return wrong("it must be \"vertex-color\" or a map of weights");
      return map_of(value, key.name, in);
    case kTexts: {
      const bool fits =
          value.is_array() && std::ranges::all_of(value, [](const Json& each) { return each.is_string(); });
      return fits ? Result<Json>(value) : wrong("it must be texts in brackets");
    }
    case kTable:
      break;
  }
  return value;
}

Result<Json> value_of_parameter(Parameter parameter, const Json& value, const WrittenIn& in) {
  const ParameterFacts& facts = facts_of(parameter);
  if (value.is_object()) {
    if (facts.blend == BlendSpace::kFactor) return unfit_material(in, facts.name, "it cannot be a map");
    Result<Json> map = map_of(value, facts.name, in);
    if (!map) return map;
    if (!is_unit_of(facts, *map)) {
      return unfit_material(
          in, facts.name,
          fmt::format("it is in {}, and the map in {}; convert the map, or say scale",
                      *facts.unit == 0 ? "no unit" : facts.unit, (*map)["unit"].get<std::string>()));
    }
    return map;
  }
  const auto count = static_cast<std::size_t>(numbers_of(facts.kind));
  const Json list = value.is_number() && count == 1 ? Json::array({value}) : value;
  const bool are_numbers =
      list.is_array() && list.size() == count && std::ranges::all_of(list, [](const Json& n) {
        return n.is_number() && std::isfinite(n.get<double>());
      });
  if (!are_numbers)
    return unfit_material(
        in, facts.name,
        fmt::format("it must be {} or a map", count == 1 ? "a number" : fmt::format("{} numbers", count)));
  for (const Json& each : list) {
    if (is_within(each, facts.least, facts.most)) continue;
    return unfit_material(in, facts.name,
                          fmt::format("{:g} is out of {}", each.get<double>(),
                                      range_words(facts.least, facts.most, facts.unit)));
  }
  if (facts.kind == ParameterKind::kBinary && list[0] != 0 && list[0] != 1)
    return unfit_material(in, facts.name,
                          fmt::format("{:g} is neither 0 nor 1; mix a metal and another material by layers",
                                      list[0].get<double>()));
  if (facts.kind == ParameterKind::kNormal && !(list[2].get<double>() > 0))
    return unfit_material(in, facts.name, "its z must be above 0");
  return Json(list.get<std::vector<double>>());
}

}  // namespace weft::material
