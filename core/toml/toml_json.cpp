// SPDX-License-Identifier: Apache-2.0
#include "core/toml/toml_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/files.h"

namespace weft {

Result<toml::table> parse_toml(std::string_view text, const std::string& where) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& e) {
    return Error{ErrorKind::kBadData, "the description cannot be used",
                 fmt::format("{}: line {}", where, e.source().begin.line), std::string(e.description()),
                 "correct it there"};
  }
}

Result<toml::table> read_toml(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  return parse_toml(*text, file.string());
}

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

std::optional<std::vector<std::vector<double>>> rows_of(const Json& list, std::size_t each) {
  if (!list.is_array()) return {};
  std::vector<std::vector<double>> rows;
  for (const Json& row : list) {
    const bool fits =
        row.is_array() && row.size() == each && std::ranges::all_of(row, [](const Json& number) {
          return number.is_number() && std::isfinite(number.get<double>());
        });
    if (!fits) return {};
    rows.push_back(row.get<std::vector<double>>());
  }
  return rows;
}

}  // namespace weft
