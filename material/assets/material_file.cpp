// SPDX-License-Identifier: Apache-2.0
#include "material/assets/material_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/number.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"
#include "material/assets/material_keys.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostLayers = 256;

class MaterialParser {
 public:
  explicit MaterialParser(const MaterialPlace& place)
      : in_{place.name, place.is_shipped() ? fs::path() : place.file.parent_path()} {
    file_.place = place;
  }

  Result<MaterialFile> parse(const Json& document) {
    if (Result<void> ok = read_schema(document); !ok) return std::move(ok).error();
    for (const auto& [name, value] : document.items()) {
      if (Result<void> ok = read_top(name, value); !ok) return std::move(ok).error();
    }
    return std::move(file_);
  }

 private:
  KeptValue kept(Json value) const { return {std::move(value), file_.place.name}; }

  Result<void> read_schema(const Json& document) const {
    const std::string schema = document.contains("schema") && document["schema"].is_string()
                                   ? document["schema"].get<std::string>()
                                   : "";
    const std::string prefix = std::string(kMaterialSchema) + "/";
    int major = 0;
    if (schema.starts_with(prefix))
      major =
          as_whole_number<int>(schema.substr(prefix.size(), schema.find('.', prefix.size()) - prefix.size()))
              .value_or(0);
    if (major == 1) return {};
    if (major > 1)
      return unfit_material(
          in_, "schema",
          fmt::format("it is {}, and this weft reads {}1; a newer weft is needed", schema, prefix));
    return unfit_material(in_, "schema", fmt::format("it must be \"{}1\"", prefix));
  }

  Result<void> read_top(const std::string& name, const Json& value) {
    if (name == "inherits" && value.is_array())
      return unfit_material(in_, name,
                            "a material inherits one other; compose further ones with a [[layer]] each");
    const Result<const MaterialKey*> key = known_key(name, top_keys(), in_);
    if (!key) return key.error();
    if (name == "surface") return read_parameters("surface", value, file_.surface);
    if (name == "over") return read_parameters("over", value, file_.over);
    if (name == "layer") return read_layers(value, "layer", layer_keys(), kMostLayers, file_.layers);
    if (name == "runtime") return read_runtime(value);
    Result<Json> read = value_of_key(**key, value, in_);
    if (!read) return std::move(read).error();
    if (name == "inherits") {
      file_.inherits = read->get<std::string>();
    } else if (name == "unset") {
      return read_unset(*read);
    } else if (name != "schema") {
      file_.top[name] = kept(std::move(*read));
    }
    return {};
  }

  Result<void> read_parameters(const char* table, const Json& value, KeptValues& into) {
    if (!value.is_object()) return unfit_material(in_, table, "it must be a table");
    const WrittenIn in = {fmt::format("{}: [{}]", in_.where, table), in_.folder};
    for (const auto& [name, each] : value.items()) {
      const auto parameter = parameter_named(name);
      if (!parameter) {
        std::vector<std::string> names;
        for (const ParameterFacts& facts : parameters()) names.emplace_back(facts.name);
        return unfit_material(in, name, no_such_key(names, name));
      }
      Result<Json> read = value_of_parameter(*parameter, each, in);
      if (!read) return std::move(read).error();
      into[name] = kept(std::move(*read));
    }
    return {};
  }

  Result<void> read_layers(const Json& list, const char* table, std::span<const MaterialKey> keys,
                           std::size_t most, std::vector<MaterialLayer>& into) {
    const bool are_tables =
        list.is_array() && std::ranges::all_of(list, [](const Json& each) { return each.is_object(); });
    if (!are_tables) return unfit_material(in_, table, fmt::format("it must be [[{}]], a table each", table));
    if (list.size() > most)
      return unfit_material(in_, table, fmt::format("there are {}, and {} at most", list.size(), most));
    for (std::size_t i = 0; i < list.size(); ++i) {
      const bool is_named = list[i].contains("name") && list[i]["name"].is_string() &&
                            !list[i]["name"].get<std::string>().empty();
      if (!is_named)
        return unfit_material(in_, fmt::format("[[{}]] {}", table, i + 1),
                              "it has no name; children change layers by their names");
      const std::string name = list[i]["name"].get<std::string>();
      if (std::ranges::find(into, name, &MaterialLayer::name) != into.end())
        return unfit_material(in_, fmt::format("[[{}]] {}", table, name), "there are two of this name");
      Result<MaterialLayer> layer = read_layer(list[i], name, table, keys);
      if (!layer) return std::move(layer).error();
      into.push_back(std::move(*layer));
    }
    return {};
  }

  Result<MaterialLayer> read_layer(const Json& table, const std::string& name, const char* kind,
                                   std::span<const MaterialKey> keys) const {
    MaterialLayer layer = {.name = name, .values = {}, .removes = false, .after = {}};
    const WrittenIn in = {fmt::format("{}: [[{}]] {}", in_.where, kind, name), in_.folder};
    for (const auto& [key_name, value] : table.items()) {
      const Result<const MaterialKey*> key = known_key(key_name, keys, in);
      if (!key) return key.error();
      Result<Json> read = value_of_key(**key, value, in);
      if (!read) return std::move(read).error();
      if (key_name == "remove") {
        layer.removes = read->get<bool>();
      } else if (key_name == "after") {
        layer.after = read->get<std::string>();
      } else if (key_name == "turn_deg" && std::abs(std::remainder(read->get<double>(), 90.0)) > 0) {
        return unfit_material(in, key_name,
                              "it must be a multiple of 90, so that repeats go on over borders");
      } else if (key_name != "name") {
        layer.values[key_name] = kept(std::move(*read));
      }
    }
    return layer;
  }

  Result<void> read_runtime(const Json& value) {
    if (!value.is_object()) return unfit_material(in_, "runtime", "it must be a table");
    const WrittenIn in = {in_.where + ": [runtime]", in_.folder};
    for (const auto& [name, each] : value.items()) {
      const Result<const MaterialKey*> key = known_key(name, runtime_keys(), in);
      if (!key) return key.error();
      if (name == "layer") {
        Result<void> ok = read_layers(each, "runtime.layer", runtime_layer_keys(), kMostRuntimeLayers,
                                      file_.runtime_layers);
        if (!ok) return ok;
        continue;
      }
      Result<Json> read = value_of_key(**key, each, in);
      if (!read) return std::move(read).error();
      file_.runtime[name] = kept(std::move(*read));
    }
    return {};
  }

  Result<void> read_unset(const Json& list) {
    for (const Json& each : list) {
      const std::string key = each.get<std::string>();
      const std::size_t dot = key.find('.');
      const std::string table = key.substr(0, dot),
                        rest = dot == std::string::npos ? "" : key.substr(dot + 1);
      const bool is_parameter = (table == "surface" || table == "over") && parameter_named(rest);
      const bool is_top =
          dot == std::string::npos && (key == "name" || key == "notes" || key == "size_mm" ||
                                       key == "is_tile" || key == "pixels" || key == "runtime");
      if (!is_parameter && !is_top)
        return unfit_material(
            in_, "unset",
            fmt::format("{} is nothing that can be unset; write surface.NAME, over.NAME, or a key of the top",
                        key));
      file_.unset.push_back(key);
    }
    return {};
  }

  WrittenIn in_;
  MaterialFile file_;
};

}  // namespace

Result<MaterialFile> parse_material(std::string_view text, const MaterialPlace& place) {
  Json document;
  try {
    document = weft::json_of(toml::parse(text));
  } catch (const toml::parse_error& e) {
    return Error{ErrorKind::kBadData, "the material cannot be used",
                 fmt::format("{}: line {}", place.name, e.source().begin.line), std::string(e.description()),
                 "correct it there"};
  }
  return MaterialParser(place).parse(document);
}

Result<MaterialFile> read_material(const MaterialPlace& place) {
  const Result<std::string> text = material_text(place);
  if (!text) return text.error();
  return parse_material(*text, place);
}

}  // namespace weft::material
