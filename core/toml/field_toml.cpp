// SPDX-License-Identifier: Apache-2.0
#include "core/toml/field_toml.h"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "core/toml/toml_json.h"

namespace weft {
namespace {

/// A key that no field has, and where it stands.
struct UnknownKey {
  std::string where, key, nearest;
};

std::optional<UnknownKey> unknown_key(const Json& object, const Json& schema, const std::string& where) {
  const Json& properties = schema["properties"];
  for (const auto& [key, value] : object.items()) {
    if (!properties.contains(key)) {
      std::vector<std::string> known;
      for (const auto& [name, property] : properties.items()) known.push_back(name);
      return UnknownKey{where, key, nearest_word(known, key)};
    }
    const Json inside = properties[key].value("items", Json::object());
    if (!inside.contains("properties") || !value.is_array()) continue;
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!value[i].is_object()) continue;
      auto found = unknown_key(value[i], inside, fmt::format("{}: {} {}", where, key, i + 1));
      if (found) return found;
    }
  }
  return {};
}

void append(std::string& text, const Json& object) {
  for (const auto& [key, value] : object.items()) {
    const bool is_tables = value.is_array() && !value.empty() && value[0].is_object();
    if (!is_tables) text += fmt::format("{} = {}\n", key, value.dump());
  }
  for (const auto& [key, value] : object.items()) {
    if (!value.is_array() || value.empty() || !value[0].is_object()) continue;
    for (const Json& each : value) {
      text += fmt::format("\n[[{}]]\n", key);
      append(text, each);
    }
  }
}

}  // namespace

Result<void> read_table(const toml::table& table, const std::string& where, const std::string& page,
                        const Json& schema, const std::function<void(Fields&)>& walk) {
  const auto unusable = [&](std::string place, std::string why) {
    return Error{ErrorKind::kBadData, "the description cannot be used", std::move(place), std::move(why),
                 fmt::format("see {} for the keys of this file", page)};
  };
  const Json document = json_of(table);
  if (const auto unknown = unknown_key(document, schema, where)) {
    return unusable(fmt::format("{}: {}", unknown->where, unknown->key),
                    fmt::format("there is no such key; the nearest is {}", unknown->nearest));
  }
  JsonReader reader(document, where);
  walk(reader);
  const Result<void> read = reader.status();
  return read ? read : unusable(read.error().where, read.error().why);
}

std::string toml_of(const Json& object) {
  std::string text;
  append(text, object);
  return text;
}

}  // namespace weft
