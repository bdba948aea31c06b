// SPDX-License-Identifier: Apache-2.0
#include "core/toml/toml_json.h"

namespace weft {

Json json_of(const toml::node& node) {
  if (const toml::table* table = node.as_table()) {
    Json object = Json::object();
    for (const auto& [key, value] : *table) object[std::string(key.str())] = json_of(value);
    return object;
  }
  if (const toml::array* array = node.as_array()) {
    Json list = Json::array();
    for (const toml::node& value : *array) list.push_back(json_of(value));
    return list;
  }
  if (const auto flag = node.as_boolean()) return flag->get();
  if (const auto whole = node.as_integer()) return whole->get();
  if (const auto number = node.value<double>()) return *number;
  if (const auto text = node.value<std::string>()) return *text;
  return nullptr;
}

}  // namespace weft
