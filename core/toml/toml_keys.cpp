// SPDX-License-Identifier: Apache-2.0
#include "core/toml/toml_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/files.h"
#include "core/text.h"

namespace weft {
namespace {

constexpr const char* kUnusable = "the description cannot be used";

}  // namespace

Result<toml::table> parse_toml(std::string_view text, const std::string& where) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& e) {
    return Error{ErrorKind::kBadData, kUnusable, fmt::format("{}: line {}", where, e.source().begin.line),
                 std::string(e.description()), "correct it there"};
  }
}

Result<toml::table> read_toml(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  return parse_toml(*text, file.string());
}

void TomlKeys::know(std::initializer_list<std::string_view> names) {
  for (const auto& [key, value] : *table_) {
    if (std::find(names.begin(), names.end(), key.str()) != names.end()) continue;
    const auto far = [written = key.str()](std::string_view name) { return edit_distance(written, name); };
    const auto nearest = std::min_element(
        names.begin(), names.end(), [&](std::string_view a, std::string_view b) { return far(a) < far(b); });
    const std::string hint = nearest == names.end() ? "" : "; the nearest is " + std::string(*nearest);
    reject(std::string(key.str()), "there is no such key" + hint);
  }
}

double TomlKeys::number(const char* key, double least, double most) {
  const std::vector<double> all = numbers(key, 1, 1);
  return all.empty() ? least : within(key, all[0], least, most);
}

double TomlKeys::number_or(const char* key, double otherwise, double least, double most) {
  return has(key) ? number(key, least, most) : otherwise;
}

int TomlKeys::integer_or(const char* key, int otherwise, int least, int most) {
  const double value = number_or(key, otherwise, least, most);
  if (value != std::floor(value)) reject(key, "it must be a whole number");
  return static_cast<int>(value);
}

std::vector<double> TomlKeys::numbers(const char* key, std::size_t fewest, std::size_t most) {
  const toml::node* node = table_->get(key);
  if (node == nullptr) {
    reject(key, "it is missing");
    return {};
  }
  std::vector<double> all;
  if (const auto alone = node->value<double>(); alone && fewest == 1) all.push_back(*alone);
  if (const toml::array* list = node->as_array()) {
    for (const toml::node& entry : *list) {
      if (const auto value = entry.value<double>()) all.push_back(*value);
    }
    if (all.size() != list->size()) all.clear();
  }
  const bool finite = std::all_of(all.begin(), all.end(), [](double v) { return std::isfinite(v); });
  if (finite && all.size() >= fewest && all.size() <= most && (fewest == 1 || all.size() == most)) return all;
  reject(key, most == 1 ? "it must be a number" : fmt::format("it must be {} numbers", most));
  return {};
}

double TomlKeys::within(const char* key, double value, double least, double most) {
  if (!(value >= least && value <= most)) reject(key, fmt::format("it must be {} to {}", least, most));
  return value;
}

bool TomlKeys::flag_or(const char* key, bool otherwise) {
  if (!has(key)) return otherwise;
  const auto value = table_->get(key)->value_exact<bool>();
  if (!value) reject(key, "it must be true or false");
  return value.value_or(otherwise);
}

std::string TomlKeys::text_or(const char* key, std::string otherwise) {
  if (!has(key)) return otherwise;
  const auto value = table_->get(key)->value<std::string>();
  if (!value) reject(key, "it must be a text");
  return value.value_or(otherwise);
}

std::vector<std::string> TomlKeys::texts_or(const char* key, std::vector<std::string> otherwise) {
  if (!has(key)) return otherwise;
  const toml::array* list = table_->get(key)->as_array();
  std::vector<std::string> all;
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    if (const auto value = (*list)[i].value<std::string>()) all.push_back(*value);
  }
  if (list == nullptr || all.size() != list->size()) reject(key, "it must be texts in brackets");
  return all;
}

const toml::table& TomlKeys::table(const char* key) {
  static const toml::table kNone;
  const toml::node* node = table_->get(key);
  if (node != nullptr && node->as_table() == nullptr) reject(key, "it must be a table");
  return node != nullptr && node->as_table() != nullptr ? *node->as_table() : kNone;
}

std::vector<const toml::table*> TomlKeys::tables(const char* key) {
  std::vector<const toml::table*> tables;
  const toml::node* node = table_->get(key);
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    if ((*list)[i].as_table() != nullptr) tables.push_back((*list)[i].as_table());
  }
  if (list == nullptr || tables.empty() || tables.size() != list->size())
    reject(key, fmt::format("there is no [[{}]]", key));
  return tables;
}

void TomlKeys::reject(const std::string& key, std::string why) {
  if (error_) return;
  error_ = Error{ErrorKind::kBadData, kUnusable, fmt::format("{}: {}", where_, key), std::move(why),
                 fmt::format("see {} for the keys of this file", page_)};
}

}  // namespace weft
