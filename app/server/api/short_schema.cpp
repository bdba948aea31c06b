// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/short_schema.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace weft::app {
namespace {

constexpr std::array<std::pair<std::string_view, const char*>, 5> kTypes = {{{"text", "string"},
                                                                             {"flag", "boolean"},
                                                                             {"number", "number"},
                                                                             {"whole", "integer"},
                                                                             {"object", "object"}}};

/// "list of Frame or null: The newest first", cut at its joints.
struct Phrase {
  bool is_list = false, may_be_null = false;
  std::string_view noun, description;
};

Phrase phrase_of(std::string_view text) {
  constexpr std::string_view kList = "list of ", kNull = " or null", kColon = ": ";
  Phrase phrase;
  const std::size_t colon = text.find(kColon);
  if (colon != text.npos) phrase.description = text.substr(colon + kColon.size());
  phrase.noun = text.substr(0, colon);
  phrase.may_be_null = phrase.noun.ends_with(kNull);
  if (phrase.may_be_null) phrase.noun.remove_suffix(kNull.size());
  phrase.is_list = phrase.noun.starts_with(kList);
  if (phrase.is_list) phrase.noun.remove_prefix(kList.size());
  return phrase;
}

Json schema_of(std::string_view noun) {
  const auto* const type = std::ranges::find(kTypes, noun, &std::pair<std::string_view, const char*>::first);
  if (type != kTypes.end()) return {{"type", type->second}};
  if (noun.find('|') == noun.npos) return {{"$ref", "#/components/schemas/" + std::string(noun)}};
  Json words = Json::array();
  for (std::size_t begin = 0; begin <= noun.size();) {
    const std::size_t end = std::min(noun.find('|', begin), noun.size());
    words.push_back(noun.substr(begin, end - begin));
    begin = end + 1;
  }
  return {{"type", "string"}, {"enum", std::move(words)}};
}

/// What stands beside a "$ref" is not read: then it is one of allOf.
Json said_of(Json schema, const Phrase& phrase) {
  if (phrase.is_list) schema = {{"type", "array"}, {"items", std::move(schema)}};
  const bool is_more = phrase.may_be_null || !phrase.description.empty();
  if (is_more && schema.contains("$ref")) schema = {{"allOf", Json::array({std::move(schema)})}};
  if (phrase.may_be_null) schema["nullable"] = true;
  if (!phrase.description.empty()) schema["description"] = phrase.description;
  return schema;
}

bool is_openapi(const Json& schema) {
  constexpr std::array kOwn = {"$ref", "allOf", "oneOf", "additionalProperties"};
  if (std::ranges::any_of(kOwn, [&](const char* key) { return schema.contains(key); })) return true;
  constexpr std::array kOwnTypes = {"object", "string", "integer", "number", "boolean", "array"};
  return std::ranges::find(kOwnTypes, schema.value("type", Json())) != kOwnTypes.end();
}

Json object_of_fields(const Json& fields) {
  Json needed = Json::array(), properties = Json::object();
  for (const auto& [key, value] : fields.items()) {
    if (key == "//") continue;
    const bool may_be_absent = key.ends_with('?');
    const std::string name = key.substr(0, key.size() - (may_be_absent ? 1 : 0));
    if (!may_be_absent) needed.push_back(name);
    properties[name] = written_out(value);
  }
  Json object = {{"type", "object"}};
  if (!needed.empty()) object["required"] = std::move(needed);
  object["properties"] = std::move(properties);
  return object;
}

}  // namespace

Json written_out(const Json& short_schema) {
  if (short_schema.is_string()) {
    const std::string text = short_schema.get<std::string>();
    const Phrase phrase = phrase_of(text);
    return said_of(schema_of(phrase.noun), phrase);
  }
  if (!short_schema.is_object() || is_openapi(short_schema)) return short_schema;
  const std::string own = short_schema.value("//", "");
  Phrase phrase = phrase_of(own);
  phrase.is_list = phrase.noun == "list";
  phrase.may_be_null = phrase.may_be_null || phrase.noun == "or null";
  return said_of(object_of_fields(short_schema), phrase);
}

}  // namespace weft::app
