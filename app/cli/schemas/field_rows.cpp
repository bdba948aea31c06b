// SPDX-License-Identifier: Apache-2.0
#include "app/cli/schemas/field_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace weft::app {
namespace {

std::string list_words(const Json& list) {
  const std::string each = kind_of(list.value("items", Json::object()));
  if (list.contains("maxItems") && list.value("minItems", Json()) == list["maxItems"])
    return fmt::format("{} x {}", list["maxItems"].get<int>(), each);
  return each.empty() ? "list" : "list of " + each;
}

std::string range_words(const Json& schema) {
  const auto bound = [&](const char* key) { return fmt::format("{}", schema[key].get<double>()); };
  if (schema.contains("exclusiveMinimum"))
    return schema.contains("maximum") ? " above 0, at most " + bound("maximum") : " above 0";
  if (schema.contains("minimum") && schema.contains("maximum"))
    return fmt::format(" {} to {}", bound("minimum"), bound("maximum"));
  return schema.contains("minimum") ? " from " + bound("minimum") : "";
}

bool is_needed(const Json& schema, const std::string& field) {
  const Json needed = schema.value("required", Json::array());
  return std::ranges::find(needed, Json(field)) != needed.end();
}

/// A row a field, what is within behind its own: `leds[].mu`.
void add_rows(const Json& schema, const std::string& before, std::string& page) {
  for (const auto& [name, field] : schema["properties"].items()) {
    if (before.empty() && name == "schema") continue;
    const bool is_list = field.value("items", Json()).contains("properties");
    page += fmt::format("| `{}{}` | {} | {}{} |\n", before, name, kind_of(field),
                        is_needed(schema, name) ? "" : "*may be absent.* ", field.value("description", ""));
    const Json& inside = is_list ? field["items"] : field;
    if (inside.contains("properties"))
      add_rows(inside, fmt::format("{}{}{}.", before, name, is_list ? "[]" : ""), page);
  }
}

}  // namespace

std::string kind_of(const Json& schema) {
  if (schema.value("nullable", false)) {
    Json one = schema;
    one.erase("nullable");
    return kind_of(one) + " or null";
  }
  if (schema.contains("enum")) {
    std::vector<std::string> words;
    for (const Json& word : schema["enum"]) words.push_back("`" + word.get<std::string>() + "`");
    return fmt::format("{}", fmt::join(words, ", "));
  }
  const Json type = schema.value("type", Json());
  if (type.is_array()) {
    std::vector<std::string> kinds;
    for (const Json& each : type) {
      Json one = schema;
      one["type"] = each;
      kinds.push_back(each == "null" ? "null" : kind_of(one));
    }
    std::erase(kinds, "");
    return fmt::format("{}", fmt::join(kinds, " or "));
  }
  if (type == "array") return list_words(schema);
  if (type == "string") return "text";
  if (type == "boolean") return "true, false";
  if (type == "integer") return "whole number" + range_words(schema);
  return type == "number" ? "number" + range_words(schema) : "";
}

std::string field_table(const Json& schema) {
  std::string table = "| field | holds | what it is |\n|---|---|---|\n";
  add_rows(schema, "", table);
  return table;
}

}  // namespace weft::app
