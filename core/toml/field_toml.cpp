// SPDX-License-Identifier: Apache-2.0
#include "core/toml/field_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/toml/toml_json.h"

namespace weft {
namespace {

/// A key that no field has, where it stands, and what is said of it.
struct UnknownKey {
  std::string where, key, why;
};

std::optional<UnknownKey> unknown_key(const Json& object, const Json& schema, const std::string& where) {
  const Json& properties = schema["properties"];
  for (const auto& [key, value] : object.items()) {
    if (!properties.contains(key)) {
      std::vector<std::string> known;
      for (const auto& [name, property] : properties.items()) known.push_back(name);
      return UnknownKey{where, key, no_such_key(known, key)};
    }
    const bool is_list = value.is_array();
    const Json inside = is_list ? properties[key].value("items", Json::object()) : properties[key];
    if (!inside.contains("properties")) continue;
    const Json each = is_list ? value : Json::array({value});
    for (std::size_t i = 0; i < each.size(); ++i) {
      if (!each[i].is_object()) continue;
      const std::string place = is_list ? fmt::format("{} {}", key, i + 1) : fmt::format("[{}]", key);
      if (auto found = unknown_key(each[i], inside, fmt::format("{}: {}", where, place))) return found;
    }
  }
  return {};
}

// 6.0 is a whole number, too.
Json with_whole_numbers(Json value) {
  constexpr double kMost = 1e9;
  if (value.is_structured()) {
    for (Json& each : value) each = with_whole_numbers(std::move(each));
  } else if (value.is_number_float()) {
    const double number = value.get<double>();
    if (std::abs(number) < kMost && number == std::floor(number)) value = static_cast<int>(number);
  }
  return value;
}

std::string quoted(const std::string& key) {
  const bool is_bare = !key.empty() && std::ranges::all_of(key, [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-');
  });
  return is_bare ? key : Json(key).dump();
}

void append(std::string& text, const Json& object) {
  for (const auto& [key, value] : object.items()) {
    const bool is_tables = value.is_array() && !value.empty() && value[0].is_object();
    if (!is_tables) text += fmt::format("{} = {}\n", quoted(key), value.dump());
  }
  for (const auto& [key, value] : object.items()) {
    if (!value.is_array() || value.empty() || !value[0].is_object()) continue;
    for (const Json& each : value) {
      text += fmt::format("\n[[{}]]\n", quoted(key));
      append(text, each);
    }
  }
}

}  // namespace

Error unusable_description(std::string where, const std::string& page, std::string why) {
  return {ErrorKind::kBadData, "the description cannot be used", std::move(where), std::move(why),
          fmt::format("see {} for the keys of this file", page)};
}

std::string no_such_key(const std::vector<std::string>& known, std::string_view key) {
  return "there is no such key; the nearest is " + nearest_word(known, key);
}

Result<void> read_table(const toml::table& table, const std::string& where, const std::string& page,
                        const Json& schema, const std::function<void(Fields&)>& walk) {
  const auto unusable = [&](std::string place, std::string why) {
    return unusable_description(std::move(place), page, std::move(why));
  };
  const Json document = with_whole_numbers(json_of(table));
  if (const auto unknown = unknown_key(document, schema, where)) {
    return unusable(fmt::format("{}: {}", unknown->where, unknown->key), unknown->why);
  }
  JsonReader reader(document, where, Naming::kOfPeople);
  walk(reader);
  const Result<void> read = reader.status();
  if (read) return read;
  // "\"port\" must be ...": the key is part of the place.
  const auto& [place, why] = std::pair(read.error().where, read.error().why);
  const std::size_t end = why.starts_with('"') ? why.find("\" ") : why.npos;
  if (end == why.npos) return unusable(place, why);
  return unusable(fmt::format("{}: {}", place, why.substr(1, end - 1)), why.substr(end + 2));
}

std::string toml_of(const Json& object) {
  std::string text;
  append(text, object);
  return text;
}

}  // namespace weft
