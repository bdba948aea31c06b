// SPDX-License-Identifier: Apache-2.0
#include "tests/app/server/api/json_schema.h"

#include <algorithm>
#include <set>

namespace weft::app {
namespace {

const std::set<std::string> kUnderstood = {"$ref", "allOf", "nullable", "type", "enum", "required",
                                           "properties", "additionalProperties", "items", "minimum",
                                           "maximum", "minLength", "maxLength",
                                           // say nothing of the value, or only of requests
                                           "description", "pattern", "format"};

bool has_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  return type == "number" && value.is_number();
}

using Misfits = std::vector<std::string>;

void append(Misfits& all, Misfits more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

Misfits in_object(const Json& value, const Json& schema, const Json& document, const std::string& where) {
  Misfits found;
  for (const Json& key : schema.value("required", Json::array())) {
    if (!value.contains(key.get<std::string>())) found.push_back(where + ": no " + key.get<std::string>());
  }
  const Json properties = schema.value("properties", Json::object());
  for (const auto& [key, each] : value.items()) {
    if (properties.contains(key)) {
      append(found, misfits(each, properties[key], document, where + "/" + key));
    } else if (schema.value("additionalProperties", true) == false) {
      found.push_back(where + ": " + key + " is not described");
    }
  }
  return found;
}

Misfits in_scalar(const Json& value, const Json& schema, const std::string& where) {
  Misfits found;
  const auto object = [&](bool fits, const char* word) {
    if (!fits) found.push_back(where + ": " + value.dump() + " breaks " + word);
  };
  if (schema.contains("enum")) {
    object(std::ranges::find(schema["enum"], value) != schema["enum"].end(), "enum");
  }
  if (value.is_number() && schema.contains("minimum")) object(value >= schema["minimum"], "minimum");
  if (value.is_number() && schema.contains("maximum")) object(value <= schema["maximum"], "maximum");
  const std::size_t length = value.is_string() ? value.get_ref<const std::string&>().size() : 0;
  if (value.is_string() && schema.contains("minLength")) object(length >= schema["minLength"], "minLength");
  if (value.is_string() && schema.contains("maxLength")) object(length <= schema["maxLength"], "maxLength");
  return found;
}

}  // namespace

const Json& followed(const Json& node, const Json& document) {
  if (!node.contains("$ref")) return node;
  return document.at(Json::json_pointer(node["$ref"].get<std::string>().substr(1)));
}

std::vector<std::string> misfits(const Json& value, const Json& schema, const Json& document,
                                 const std::string& where) {
  if (schema.contains("$ref")) return misfits(value, followed(schema, document), document, where);
  Misfits found;
  for (const auto& [word, ignored] : schema.items()) {
    if (!kUnderstood.contains(word)) found.push_back(where + ": the schema says " + word);
  }
  if (value.is_null() && schema.value("nullable", false)) return found;
  for (const Json& part : schema.value("allOf", Json::array()))
    append(found, misfits(value, part, document, where));
  if (schema.contains("type") && !has_type(value, schema["type"])) {
    found.push_back(where + ": " + value.dump().substr(0, 60) + " is no " +
                    schema["type"].get<std::string>());
    return found;
  }
  if (value.is_object()) append(found, in_object(value, schema, document, where));
  for (std::size_t i = 0; value.is_array() && schema.contains("items") && i < value.size(); ++i) {
    append(found, misfits(value[i], schema["items"], document, where + "/" + std::to_string(i)));
  }
  append(found, in_scalar(value, schema, where));
  return found;
}

}  // namespace weft::app
